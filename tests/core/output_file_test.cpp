#include "pcednet/core/output_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

namespace pcednet {
namespace {

TEST(OutputFile, WritesBackIntoWhatItWroteBefore) {
  const auto path =
      std::filesystem::temp_directory_path() / ("pcednet-output-file-" + std::to_string(getpid()));
  for (const std::size_t size : {100, 5000, 3000000}) {
    const std::string mark = "mark";
    std::string wanted(size, 'a');
    OutputFile out(path, Overwrite::kYes);
    out.write(wanted);
    out.write_at(50, std::as_bytes(std::span(mark)));
    out.write("the end");
    out.commit();
    wanted.replace(50, mark.size(), mark);
    std::ifstream file(path, std::ios::binary);
    const std::string got{std::istreambuf_iterator<char>(file), {}};
    EXPECT_TRUE(got == wanted + "the end") << size << " bytes";
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace pcednet
