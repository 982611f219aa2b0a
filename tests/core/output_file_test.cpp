#include "pcednet/core/output_file.h"

#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>

#include "pcednet/core/error.h"
#include "pcednet/core/exists_already.h"
#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet {
namespace {

namespace fs = std::filesystem;

class OutputFileTest : public testing::Test, protected test::OwnFolder {
 protected:
  std::string content(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::set<std::string> names() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename());
    return names;
  }
};

/// The exit status of a process of its own that does `work`.
int in_process(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    const auto error = test::error_of(work);
    _exit(error ? static_cast<int>(error->kind()) : 0);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// As on a file system that knows no rename without replacing: the kernel answers EINVAL.
void refuse_renameat2() {
  sock_filter rules[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_renameat2, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EINVAL),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog program = {std::size(rules), rules};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) {
    _exit(77);
  }
}

TEST_F(OutputFileTest, WritesBackIntoWhatItWroteBefore) {
  for (const std::size_t size : {100, 5000, 3000000}) {
    const std::string mark = "mark";
    std::string wanted(size, 'a');
    OutputFile out(path("a"), Overwrite::kYes);
    out.write(wanted);
    out.write_at(50, std::as_bytes(std::span(mark)));
    out.write("the end");
    out.commit();
    wanted.replace(50, mark.size(), mark);
    EXPECT_TRUE(content("a") == wanted + "the end") << size << " bytes";
  }
}

TEST_F(OutputFileTest, LeavesNothingWithoutACommit) {
  { OutputFile(path("a")).write("half"); }
  EXPECT_EQ(names(), std::set<std::string>());
}

TEST_F(OutputFileTest, NeverReplacesAFileThatAppearedWhileItWasWritten) {
  OutputFile first(path("a")), second(path("a"));
  first.write("first");
  second.write("second");
  first.commit();
  EXPECT_ERROR(ErrorKind::kUsage, second.commit());
  EXPECT_EQ(content("a"), "first");
}

TEST_F(OutputFileTest, LeavesNoPartWhereTheNameWasTakenMeanwhile) {
  {
    OutputFile out(path("a"));
    std::ofstream(path("a")) << "precious";
    EXPECT_ERROR(ErrorKind::kUsage, out.commit());
  }
  EXPECT_EQ(names(), std::set<std::string>{"a"});
  EXPECT_EQ(content("a"), "precious");
}

TEST_F(OutputFileTest, NeverReplacesWhereTheFileSystemHasNoSuchRename) {
  EXPECT_EQ(in_process([&] {
              refuse_renameat2();
              OutputFile first(path("a")), second(path("a"));
              first.write("first");
              first.commit();
              if (!test::throws_error(ErrorKind::kUsage, [&] { second.commit(); })) _exit(99);
            }),
            0);
  EXPECT_EQ(content("a"), "first");
  EXPECT_EQ(fs::hard_link_count(path("a")), 1u);
  EXPECT_EQ(names(), std::set<std::string>{"a"});
}

TEST_F(OutputFileTest, ReplacesAFileThatAppearedWhereItMay) {
  OutputFile out(path("a"), Overwrite::kYes);
  out.write("new");
  std::ofstream(path("a")) << "old";
  out.commit();
  EXPECT_EQ(content("a"), "new");
}

TEST_F(OutputFileTest, RefusesBeforeTheWorkWhatCannotBeWrittenAfterIt) {
  std::ofstream(path("file")) << "x";
  fs::create_symlink("nothing", path("link"));
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  check_writable(path("new"), Overwrite::kNo);
  check_writable(path("file"), Overwrite::kYes);
  EXPECT_ERROR(ErrorKind::kUsage, check_writable(path("file"), Overwrite::kNo));
  EXPECT_THROW(check_writable(path("file"), Overwrite::kNo), ExistsAlready);
  EXPECT_ERROR(ErrorKind::kUsage, check_writable(path("link"), Overwrite::kNo));
  EXPECT_ERROR(ErrorKind::kUsage, check_writable(path("pipe"), Overwrite::kYes));
  EXPECT_ERROR(ErrorKind::kUsage, check_writable(path(""), Overwrite::kYes));  // the folder itself
  EXPECT_ERROR(ErrorKind::kFailure, check_writable(path("none/new"), Overwrite::kNo));
  EXPECT_ERROR(ErrorKind::kFailure, check_writable(path("file/new"), Overwrite::kYes));
  EXPECT_ERROR(ErrorKind::kFailure,
               check_writable(path(std::string(255, 'n')), Overwrite::kNo));  // and .part
  EXPECT_ERROR(ErrorKind::kUsage, check_writable("/dev/full", Overwrite::kYes));
  EXPECT_ERROR(ErrorKind::kUsage, OutputFile(""));
}

TEST_F(OutputFileTest, RefusesAFolderThatOthersOwn) {
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(in_process([&] {
              if (getuid() == 0 && setuid(65534) != 0) _exit(77);  // root writes everywhere
              check_writable(path("new"), Overwrite::kNo);
            }),
            static_cast<int>(ErrorKind::kFailure));
  fs::permissions(folder_, fs::perms::owner_all);
}

TEST_F(OutputFileTest, MakesFoldersAndRefusesFilesInTheirPlace) {
  make_folder(path("a/b/c"));
  make_folder(path("a/b/c/"));
  EXPECT_TRUE(fs::is_directory(path("a/b/c")));
  std::ofstream(path("file")) << "x";
  EXPECT_ERROR(ErrorKind::kUsage, make_folder(path("file")));
  EXPECT_ERROR(ErrorKind::kFailure, make_folder(path("file/b")));
}

}  // namespace
}  // namespace pcednet
