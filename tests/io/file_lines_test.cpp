#include "pcednet/io/file_lines.h"

#include <gtest/gtest.h>

#include "io/scratch.h"
#include "pcednet/io/text/number_table.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

std::vector<std::string> lines_of(const Scratch& scratch, const std::string& text) {
  const InputFile file(scratch.file("a.txt", text));
  FileLines lines(file);
  std::vector<std::string> all;
  std::string_view line;
  while (lines.next(line)) all.emplace_back(line);
  EXPECT_EQ(lines.number(), all.size());
  return all;
}

TEST(FileLines, AreThoseOfTheTextInMemory) {
  const Scratch scratch;
  std::string text = "\xEF\xBB\xBF";
  while (text.size() < 3'000'000) text += std::string(text.size() % 97, 'a') + "\r\n\n";
  for (const std::string end : {"", "last", "last\r"}) {
    Lines lines(without_mark(text));
    std::vector<std::string> expected;
    std::string_view line;
    while (lines.next(line)) expected.emplace_back(line);
    if (!end.empty()) expected.emplace_back("last");
    EXPECT_EQ(lines_of(scratch, text + end), expected);
  }
}

TEST(FileLines, MayBeLongerThanAPartOfTheFile) {
  const Scratch scratch;
  const std::string line(2'500'000, 'b');
  EXPECT_EQ(lines_of(scratch, line + "\n" + line), std::vector<std::string>({line, line}));
  EXPECT_TRUE(lines_of(scratch, "").empty());
}

TEST(FileLines, EndAsTheFirstDoes) {
  const Scratch scratch;
  EXPECT_EQ(lines_of(scratch, "a\rb\rc"), std::vector<std::string>({"a", "b", "c"}));
  EXPECT_EQ(lines_of(scratch, std::string("\xFF\xFE"
                                          "a\0\n\0b\0",
                                          8)),
            std::vector<std::string>({"a", "b"}));
}

TEST(FileLines, GoOnFromTheSameLineInACopy) {
  const Scratch scratch;
  const InputFile file(scratch.file("a.txt", "a\nb\nc\n"));
  FileLines lines(file);
  std::string_view line;
  ASSERT_TRUE(lines.next(line));
  FileLines ahead = lines;
  ASSERT_TRUE(ahead.next(line) && ahead.next(line));
  EXPECT_EQ(line, "c");
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, "b");
}

TEST(NumberTable, MovesItsRowsToABuilder) {
  constexpr std::size_t kRows = 200'000;
  NumberTable table(4);
  for (std::size_t r = 0; r < kRows; ++r) table.add_row()[3] = static_cast<double>(r);
  ASSERT_EQ(table.rows(), kRows);
  EXPECT_EQ(table.row(123'456)[3], 123'456.0);
  CloudBuilder builder("a.xyz", {{"x"}, {"y"}, {"z"}, {"t"}}, kRows);
  table.move_to(builder);
  EXPECT_EQ(table.rows(), 0u);
  const PointCloud cloud = builder.finish().cloud;
  const Attribute* numbers = find_attribute(cloud, "t");
  ASSERT_NE(numbers, nullptr);
  for (std::size_t r = 0; r < kRows; r += 1'111) {
    EXPECT_EQ(numbers->value(r), static_cast<double>(r));
  }
}

}  // namespace
}  // namespace pcednet::io
