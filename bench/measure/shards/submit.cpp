#include "bench/measure/shards/submit.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <sys/mman.h>
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

constexpr int kNoSuchProgram = 127;

// An open file without a name. It takes what a program says however long that is, so nobody has to read while
// the program runs.
struct MemoryFile {
  const int id;
  explicit MemoryFile(const char* name) : id(memfd_create(name, MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (id >= 0) close(id);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string text() const {
    std::string out;
    char bytes[1024];
    lseek(id, 0, SEEK_SET);
    for (ssize_t got; (got = read(id, bytes, sizeof bytes)) > 0;)
      out.append(bytes, static_cast<std::size_t>(got));
    return out;
  }
};

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
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
  const std::string sharing =
      submission.kind == ReplayKind::timings ? "#SBATCH --exclusive\n" : "#SBATCH --oversubscribe\n";
  return "#!/bin/bash\n"
         "#SBATCH --job-name=cscd\n"
         "#SBATCH --array=1-" +
         count + "\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=" + std::to_string(submission.threads) +
         "\n#SBATCH --requeue\n" + sharing + "cd " + in_quotes(fs::current_path().string()) + "\nexec " +
         command + "\n";
}

void send_to_slurm(const std::string& script) {
  const MemoryFile job("job"), errors("errors");
  if (write(job.id, script.data(), script.size()) != static_cast<ssize_t>(script.size()) ||
      lseek(job.id, 0, SEEK_SET) != 0)
    throw InputError(std::string("sbatch: the job cannot be written (") + std::strerror(errno) +
                     "); write it with --script FILE");
  std::fflush(stdout);
  const pid_t sbatch = fork();
  if (sbatch == 0) {
    dup2(job.id, STDIN_FILENO);
    dup2(errors.id, STDERR_FILENO);
    execlp("sbatch", "sbatch", nullptr);
    _exit(kNoSuchProgram);
  }
  const int status = sbatch < 0 ? kNoSuchProgram : status_of(sbatch);
  const std::string said = errors.text();
  if (status != 0)
    throw InputError(
        "sbatch: did not take the job (" +
        (status == kNoSuchProgram && said.empty() ? "there is no such program" : last_line(said)) +
        "); run this where Slurm is, or write the script with --script FILE and hand it over "
        "yourself");
  std::fputs(said.c_str(), stderr);
}

}  // namespace cscd::bench
