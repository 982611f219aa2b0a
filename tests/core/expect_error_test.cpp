#include "support/expect_error.h"

#include <stdexcept>

namespace pcednet {
namespace {

[[nodiscard]] int fail(ErrorKind kind, int) {
  throw Error(kind, "no room");
}

TEST(ExpectError, TakesTheKindThatWasAskedForAndNothingElse) {
  EXPECT_ERROR(ErrorKind::kUsage, fail(ErrorKind::kUsage, 1));
  const auto result = [](const auto& statement) {
    return test::throws_error(ErrorKind::kUsage, statement);
  };
  const auto other = result([] { throw Error(ErrorKind::kFailure, "no room"); });
  EXPECT_FALSE(other);
  EXPECT_STREQ(other.message(), "an error of kind 1 instead of 2: no room");
  EXPECT_FALSE(result([] { throw std::runtime_error("no room"); }));
  EXPECT_FALSE(result([] {}));
}

}  // namespace
}  // namespace pcednet
