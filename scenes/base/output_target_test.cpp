#include "scenes/base/output_target.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <functional>
#include <gtest/gtest.h>
#include <iterator>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"

namespace cscd {
namespace {

namespace fs = std::filesystem;

class Output : public testing::Test {
 protected:
  const test::Folder scratch;
  const fs::path folder = scratch.path;
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
};

std::string refusal(const fs::path& path, bool force = false) {
  return test::refusal([&] {
    const OutputTarget target = find_output_target(path, force);
    UnfinishedFile file(target.path, force);
    file.write("new");
    file.finish();
  });
}

TEST_F(Output, AppearsWholeOrNotAtAll) {
  {
    UnfinishedFile file(folder / "a", false);
    file.write("half");
    EXPECT_FALSE(fs::exists(folder / "a"));
    EXPECT_EQ(files(), 1u);
  }
  EXPECT_EQ(files(), 0u);
  EXPECT_EQ(refusal(folder / "a"), "");
  EXPECT_EQ(test::read(folder / "a"), "new");
  EXPECT_EQ(files(), 1u);
}

TEST_F(Output, ReplacesOnlyWhenForcedAndKeepsPermissions) {
  test::write(folder / "a", "old");
  fs::permissions(folder / "a", fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_TRUE(scenes::says(refusal(folder / "a"), "--force"));
  EXPECT_EQ(test::read(folder / "a"), "old");
  EXPECT_EQ(refusal(folder / "a", true), "");
  EXPECT_EQ(test::read(folder / "a"), "new");
  EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(Output, DoesNotReplaceWhatCameInBetween) {
  UnfinishedFile file(folder / "a", false);
  test::write(folder / "a", "came first");
  EXPECT_THROW(file.finish(), InputError);
  EXPECT_EQ(test::read(folder / "a"), "came first");
}

TEST_F(Output, TellsWhyTheSystemRefuses) {
  const auto reason = [&](const fs::path& target) {
    try {
      UnfinishedFile(target, false).finish();
    } catch (const OutputError& error) {
      return error.reason;
    }
    return 0;
  };
  EXPECT_EQ(reason(folder / "a"), 0);
  EXPECT_EQ(reason(folder / "a"), EEXIST);
  EXPECT_EQ(reason(folder / "no" / "such"), ENOENT);
}

TEST_F(Output, RemovesWhatKilledProcessesLeftLongAgo) {
  const pid_t killed = fork();
  if (killed == 0) {
    static UnfinishedFile old(folder / "a", false), fresh(folder / "b", false);
    kill(getpid(), SIGKILL);
  }
  waitpid(killed, nullptr, 0);
  const UnfinishedFile own(folder / "c", false);
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(2);
  fs::last_write_time(own.path(), long_ago);
  fs::path left;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path() != own.path()) left = entry.path();
  fs::last_write_time(left, long_ago);
  ASSERT_EQ(files(), 3u);
  remove_forsaken_files(folder);
  EXPECT_EQ(files(), 2u);
  EXPECT_TRUE(fs::exists(own.path()));
  EXPECT_FALSE(fs::exists(left));
}

TEST_F(Output, FollowsLinksAndLeavesThem) {
  test::write(folder / "a", "old");
  fs::create_symlink("a", folder / "link");
  fs::create_symlink("link", folder / "link2");
  EXPECT_NE(refusal(folder / "link2"), "");
  EXPECT_EQ(refusal(folder / "link2", true), "");
  EXPECT_EQ(test::read(folder / "a"), "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link") && fs::is_symlink(folder / "link2"));
}

TEST_F(Output, MakesTheTargetOfADanglingLink) {
  fs::create_symlink("there", folder / "link");
  EXPECT_EQ(refusal(folder / "link"), "");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_FALSE(fs::is_symlink(folder / "there"));
  EXPECT_EQ(test::read(folder / "there"), "new");
}

TEST_F(Output, RefusesLinksInACircleFoldersAndSockets) {
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  EXPECT_TRUE(scenes::says(refusal(folder / "a"), "circle"));
  EXPECT_TRUE(scenes::says(refusal(folder, true), "is a folder"));
  EXPECT_TRUE(scenes::says(refusal(folder / "no" / "such"), "cannot be created"));
  EXPECT_TRUE(scenes::says(refusal(folder / "new/"), "names a folder"));
  EXPECT_TRUE(scenes::says(refusal("", true), "empty"));

  const int handle = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  (folder / "socket").string().copy(name.sun_path, sizeof name.sun_path - 1);
  ASSERT_EQ(bind(handle, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  EXPECT_TRUE(scenes::says(refusal(folder / "socket", true), "is a socket"));
  close(handle);
}

TEST_F(Output, KnowsDevicesAndPipes) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_TRUE(find_output_target(folder / "pipe", false).is_stream);
  EXPECT_TRUE(find_output_target("/dev/null", true).is_stream);
  fs::create_symlink("/dev/null", folder / "link");
  EXPECT_TRUE(find_output_target(folder / "link", true).is_stream);
  if (mknod((folder / "disk").c_str(), S_IFBLK | 0600, makedev(259, 200)) != 0)
    GTEST_SKIP() << "may not make a device";
  EXPECT_TRUE(scenes::says(refusal(folder / "disk", true), "is a disk"));
}

TEST_F(Output, TakesTheLongestNameThatThereIs) {
  EXPECT_EQ(refusal(folder / std::string(255, 'n')), "");
  EXPECT_NE(refusal(folder / std::string(256, 'n')), "");
  EXPECT_EQ(files(), 1u);
}

TEST_F(Output, SaysThatAFolderIsReadOnly) {
  if (geteuid() != 0 || seteuid(65534) != 0) GTEST_SKIP() << "needs root, to become another user";
  const std::string text = refusal(folder / "a");
  ASSERT_EQ(seteuid(0), 0);
  EXPECT_TRUE(scenes::says(text, "Permission denied"));
}

// Forks a child process that calls begin() and is then ended by a signal. Returns the number of the signal
// that ended the child, or -1 if none did. The caller looks at what the child leaves in the folder.
int end_child_by(int signal_number, const std::function<void()>& begin, int ignored = 0) {
  const pid_t child = fork();
  if (child == 0) {
    if (ignored != signal_number) signal(signal_number, SIG_DFL);  // a background job ignores some signals
    remove_temporaries_at_signals();
    begin();
    raise(signal_number);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? WTERMSIG(status) : -1;
}

TEST_F(Output, VanishesAtSignalsThatEndTheProcess) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const int end = end_child_by(number, [&] {
      static std::optional<UnfinishedFile> several[3];
      for (int i = 0; i < 3; ++i) several[i].emplace(folder / std::to_string(i), false);
      several[1].reset();
      fs::create_directory(folder / "work");
      test::write(folder / "work" / "frames", "some");
      static const Temporary work(folder / "work");
      if (files() != 3) _exit(1);
    });
    EXPECT_EQ(end, number);
    EXPECT_EQ(files(), 0u);
  }
}

TEST_F(Output, EndsTheHelperThatWritesIntoAFolder) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const int end = end_child_by(SIGTERM, [&] {
    fs::create_directory(folder / "work");
    static const Temporary work(folder / "work");
    const pid_t process = fork();
    if (process == 0) {  // writes as long as it lives
      close(ends[0]);
      for (int i = 0;; ++i) test::write(folder / "work" / std::to_string(i), "frame");
    }
    static const TemporaryHelper helper(process);
    usleep(20'000);
  });
  EXPECT_EQ(end, SIGTERM);
  EXPECT_EQ(files(), 0u);
  close(ends[1]);
  char byte;
  EXPECT_EQ(read(ends[0], &byte, 1), 0) << "nobody holds the other end: the helper is gone";
  close(ends[0]);
}

TEST_F(Output, LeavesFinishedFilesAndThoseOfTheParentAlone) {
  UnfinishedFile of_parent(folder / "parent", false);
  EXPECT_EQ(end_child_by(SIGINT,
                         [&] {
                           UnfinishedFile file(folder / "child", false);
                           file.write("whole");
                           file.finish();
                         }),
            SIGINT);
  EXPECT_EQ(test::read(folder / "child"), "whole");
  EXPECT_NO_THROW(of_parent.finish());
}

TEST_F(Output, LetsAnIgnoredSignalBeIgnored) {
  EXPECT_EQ(end_child_by(SIGHUP, [] {}), SIGHUP);
  const auto before = signal(SIGHUP, SIG_IGN);
  EXPECT_EQ(end_child_by(
                SIGHUP, [] {}, SIGHUP),
            -1);
  signal(SIGHUP, before);
}

}  // namespace
}  // namespace cscd
