#pragma once

#include <gtest/gtest.h>

#include <exception>
#include <optional>

#include "pcednet/core/error.h"

namespace pcednet::test {

/// The Error that `statement` throws; empty if it throws none.
template <typename Statement>
std::optional<Error> error_of(const Statement& statement) {
  try {
    statement();
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

/// Success when `statement` throws an Error of the kind `wanted`, and for nothing else.
template <typename Statement>
testing::AssertionResult throws_error(ErrorKind wanted, const Statement& statement) {
  try {
    const std::optional<Error> error = error_of(statement);
    if (!error) return testing::AssertionFailure() << "no error";
    if (error->kind() == wanted) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << "an error of kind " << static_cast<int>(error->kind()) << " instead of "
           << static_cast<int>(wanted) << ": " << error->what();
  } catch (const std::exception& error) {
    return testing::AssertionFailure() << "an exception that is no Error: " << error.what();
  }
}

}  // namespace pcednet::test

/// The expression after `kind` throws an Error of that kind:
///     EXPECT_ERROR(ErrorKind::kUsage, sample_scales({1.0, 1.0}, 16)) << "more to say";
#define EXPECT_ERROR(kind, ...) \
  EXPECT_TRUE(pcednet::test::throws_error((kind), [&] { static_cast<void>(__VA_ARGS__); }))
