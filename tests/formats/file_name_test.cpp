#include "pcednet/formats/file_name.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::formats {
namespace {

namespace fs = std::filesystem;

class FileName : public testing::Test, protected test::OwnFolder {
 protected:
  void make(const std::string& name) const {
    fs::create_directories(path(name).parent_path());
    std::ofstream(path(name)) << name;
  }
};

TEST_F(FileName, IsRefusedUnlessUtf8) {
  check_is_utf8(path("caf\xC3\xA9.ply"));
  EXPECT_ERROR(ErrorKind::kUsage, check_is_utf8(path("caf\xE9.ply")));
}

TEST_F(FileName, IsFoundFromWhatJsonHoldsOfIt) {
  const std::string replaced = "\xEF\xBF\xBD";
  make("caf\xE9/lat\xFCin.ply");
  make("caf\xE9/latin.ply");
  const fs::path odd = path("caf\xE9/lat\xFCin.ply");
  EXPECT_EQ(find_written(path("caf" + replaced + "/lat" + replaced + "in.ply")), odd);
  EXPECT_EQ(find_written(path("caf\xE9/lat" + replaced + "in.ply")), odd);
  EXPECT_EQ(find_written(odd), odd);
  make("caf\xE9/lat\xE4in.ply");  // the first by the bytes
  EXPECT_EQ(find_written(path("caf\xE9/lat" + replaced + "in.ply")), path("caf\xE9/lat\xE4in.ply"));
  make("caf\xE9/lat" + replaced + "in.ply");
  const fs::path plain = path("caf\xE9/lat" + replaced + "in.ply");
  EXPECT_EQ(find_written(plain), plain);
  const fs::path none = path("caf\xE9/" + replaced + ".ply");
  EXPECT_EQ(find_written(none), none);
  EXPECT_EQ(find_written(path("none/" + replaced)), path("none/" + replaced));
}

}  // namespace
}  // namespace pcednet::formats
