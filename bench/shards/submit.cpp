#include "bench/shards/submit.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "core/base/error.h"

namespace cscd::bench {
namespace {

std::vector<std::string> worker_words(const Submission& submission, const std::string& shard) {
  std::vector<std::string> words = {"run", "--plan", submission.plan.string(),  "--shard",
                                    shard, "--into", submission.folder.string()};
  char digits[32];
  if (submission.limits.seconds) {
    std::snprintf(digits, sizeof digits, "%.17g", *submission.limits.seconds);
    words.insert(words.end(), {"--cell-seconds", digits});
  }
  if (submission.limits.memory_mib)
    words.insert(words.end(), {"--cell-memory", std::to_string(*submission.limits.memory_mib)});
  return words;
}

pid_t start_worker(std::vector<std::string> words) {
  std::string name = "cscd";
  std::vector<char*> pointers{name.data()};
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  std::fflush(stdout);
  const pid_t parent = getpid(), child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() == parent) execv("/proc/self/exe", pointers.data());
    _exit(2);
  }
  return child;
}

int status_of(pid_t worker) {
  int status = 0;
  while (waitpid(worker, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 2;
}

std::string in_quotes(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

int work_here(const Submission& submission) {
  std::vector<pid_t> workers;
  const std::string count = "/" + std::to_string(submission.workers);
  for (std::size_t i = 1; i <= submission.workers; ++i) {
    const pid_t worker = start_worker(worker_words(submission, std::to_string(i) + count));
    if (worker < 0)
      throw InputError("worker " + std::to_string(i) + count + ": cannot be started (" +
                       std::strerror(errno) + "); ask for fewer --workers");
    workers.push_back(worker);
  }
  int worst = 0;
  for (const pid_t worker : workers) worst = std::max(worst, status_of(worker));
  return worst;
}

std::string slurm_script(const Submission& submission) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const std::string program = fs::read_symlink("/proc/self/exe", ignored).string();
  const std::string count = std::to_string(submission.workers);
  std::string command = in_quotes(program);
  for (const std::string& word : worker_words(submission, "SHARD"))
    command += " " + (word == "SHARD" ? "\"$SLURM_ARRAY_TASK_ID/" + count + "\"" : in_quotes(word));
  return "#!/bin/bash\n"
         "#SBATCH --job-name=cscd\n"
         "#SBATCH --array=1-" +
         count +
         "\n"
         "#SBATCH --requeue\n"
         "cd " +
         in_quotes(fs::current_path().string()) + "\nexec " + command + "\n";
}

void send_to_slurm(const std::string& script) {
  std::fflush(stdout);
  std::FILE* sbatch = popen("command -v sbatch >/dev/null && exec sbatch", "w");
  const bool taken =
      sbatch != nullptr && std::fwrite(script.data(), 1, script.size(), sbatch) == script.size();
  const int status = sbatch == nullptr ? -1 : pclose(sbatch);
  if (!taken || status != 0)
    throw InputError(
        "sbatch: did not take the job; run this where Slurm is, or write the script with --script FILE and "
        "hand "
        "it over yourself");
}

}  // namespace cscd::bench
