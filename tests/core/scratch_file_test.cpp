#include "pcednet/core/scratch_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet {
namespace {

class ScratchFiles : public testing::Test, protected test::OwnFolder {};

std::string text_of(const ScratchFile& file, std::uint64_t offset, std::size_t count) {
  std::string text(count, '?');
  file.read(offset, std::as_writable_bytes(std::span(text)));
  return text;
}

TEST_F(ScratchFiles, GiveBackWhatWasWritten) {
  ScratchFile file(path("out.laz")), other(path("out.laz"));
  file.write("abc");
  other.write("x");
  file.write("defgh");
  EXPECT_EQ(file.size(), 8U);
  EXPECT_EQ(text_of(file, 0, 8), "abcdefgh");
  EXPECT_EQ(text_of(file, 2, 3), "cde");
  EXPECT_EQ(text_of(other, 0, 1), "x");
}

TEST_F(ScratchFiles, AreWrittenAnywhere) {
  ScratchFile file(path("out.laz"));
  const auto write_at = [&](std::uint64_t offset, std::string_view text) {
    file.write_at(offset, std::as_bytes(std::span(text)));
  };
  write_at(4, "ef");
  EXPECT_EQ(file.size(), 6U);
  EXPECT_EQ(text_of(file, 0, 6), std::string("\0\0\0\0ef", 6));
  write_at(1, "bcd");
  file.write("g");
  EXPECT_EQ(text_of(file, 1, 6), "bcdefg");
}

TEST_F(ScratchFiles, HaveNoName) {
  ScratchFile file(path("out.laz"));
  file.write("abc");
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(ScratchFiles, NeedTheFolderAndGiveNoMoreThanTheyHold) {
  EXPECT_ERROR(ErrorKind::kFailure, ScratchFile(path("nowhere/out.laz")));
  ScratchFile file(path("out.laz"));
  file.write("abc");
  EXPECT_ERROR(ErrorKind::kFailure, text_of(file, 1, 3));
}

}  // namespace
}  // namespace pcednet
