#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

namespace pcednet::test {

/// A folder of a test's own, gone after it.
class OwnFolder {
 public:
  OwnFolder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("pcednet-") + info->test_suite_name() + "-" + info->name() +
                       "-" + std::to_string(getpid());
    std::replace(name.begin(), name.end(), '/', '-');  // of a test with parameters
    folder_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::create_directories(folder_);
  }
  ~OwnFolder() { std::filesystem::remove_all(folder_); }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

 protected:
  std::filesystem::path folder_;
};

}  // namespace pcednet::test
