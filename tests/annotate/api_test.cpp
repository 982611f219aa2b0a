#include "workbench/annotate/page/api.h"

#include <gtest/gtest.h>

namespace pcednet::annotate {
namespace {

TEST(Api, KnowsItsOwnHostAsBrowsersNameIt) {
  for (const char* name : {"127.0.0.1", "localhost"}) {
    const std::string host = name;
    EXPECT_TRUE(is_own_host(host + ":8080", 8080));
    EXPECT_TRUE(is_own_host(host + ":80", 80));
    EXPECT_TRUE(is_own_host(host, 80));
    EXPECT_FALSE(is_own_host(host, 8080));
    EXPECT_FALSE(is_own_host(host + ":8081", 8080));
    EXPECT_FALSE(is_own_host(host + ".evil.example:8080", 8080));
    EXPECT_FALSE(is_own_host(host + ".evil.example", 80));
  }
  EXPECT_FALSE(is_own_host("evil.example:8080", 8080));
  EXPECT_FALSE(is_own_host("", 80));
}

}  // namespace
}  // namespace pcednet::annotate
