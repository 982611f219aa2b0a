#include "pcednet/gls/reconstruction.h"

#include <gtest/gtest.h>

namespace pcednet::gls {
namespace {

TEST(Reconstruction, IsFoundByItsName) {
  ASSERT_EQ(reconstruction_names().size(), 4u);
  EXPECT_EQ(name_of(Reconstruction::kSphereMls), "sphere-mls");
  for (const std::string_view name : reconstruction_names()) {
    EXPECT_EQ(name_of(reconstruction_of(name).value()), name);
  }
  EXPECT_FALSE(reconstruction_of("sphere mls"));
}

}  // namespace
}  // namespace pcednet::gls
