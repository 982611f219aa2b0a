#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace pcednet::test {

/// A folder of a test's own, gone after it.
class OwnFolder {
 public:
  OwnFolder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("pcednet-" + std::string(info->test_suite_name()) + "-" + info->name() + "-" +
               std::to_string(getpid()));
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
