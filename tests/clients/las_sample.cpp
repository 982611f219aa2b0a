// las_sample FORMAT MINOR POINTS EXTRA CHANNELS writes LAS 1.MINOR to stdout: points of FORMAT with
// EXTRA bytes beyond it, from CHANNELS scanner channels in turn (formats 6 to 10).
#include <iostream>

#include "io/las/las_writer.h"

int main(int count, char** words) {
  using namespace pcednet::io;
  if (count != 6) return 2;
  std::array<unsigned, 5> numbers = {};
  for (int i = 0; i < 5; ++i) numbers[static_cast<std::size_t>(i)] = std::stoul(words[i + 1]);
  const auto [format, minor, points, extra, channels] = numbers;
  LasTestFile file{format, minor, las_test_rows(format, points, extra, channels), extra};
  file.records = {{"somebody", 7, "kept as it is", "of mine"},
                  {"LASF_Projection", 34735, std::string("\1\0\1\0\0\0\0\0", 8)}};
  if (extra > 0) {
    file.records.push_back({"LASF_Spec", 4, las_test_extra("bytes", 0, extra), "extra"});
  }
  if (minor >= 4) file.extended = {{"somebody", 8, std::string(70000, 'x'), "a long one"}};
  std::cout << las_bytes(file);
}
