#include "workbench/annotate/page/windows.h"

#include <gtest/gtest.h>

#include "workbench/annotate/scene/not_found.h"

namespace pcednet::annotate {
namespace {

TEST(Windows, LetOneOfThemPaint) {
  Windows windows;
  const auto [first, first_paints] = windows.open();
  const auto [second, second_paints] = windows.open();
  EXPECT_TRUE(first_paints);
  EXPECT_FALSE(second_paints);
  windows.take_over(second);
  EXPECT_FALSE(windows.is_writer(first));
  EXPECT_EQ(windows.leave(second), first);
  EXPECT_EQ(windows.leave(first), "");
  EXPECT_TRUE(windows.open().is_writer);
  EXPECT_THROW(windows.leave(first), NotFound);
}

TEST(Windows, DoNotPassPaintingToOneThatIsSilent) {
  Windows windows;
  const std::string first = windows.open().name, second = windows.open().name;
  const std::string third = windows.open().name;
  for (const std::string& window : {first, second, third}) windows.begin_listening(window);
  windows.end_listening(third);
  EXPECT_EQ(windows.leave(first), second);
}

TEST(Windows, CloseThoseThatAreSilent) {
  Windows windows;
  const std::string first = windows.open().name, second = windows.open().name;
  windows.begin_listening(first);
  windows.begin_listening(first);  // before the first of its streams is known to have ended
  windows.end_listening(first);
  EXPECT_EQ(windows.close_silent(first), std::nullopt);
  EXPECT_TRUE(windows.is_writer(first));
  windows.end_listening(first);
  EXPECT_EQ(windows.close_silent(first), second);
  EXPECT_FALSE(windows.is_open(first));
}

TEST(Windows, OpenAgainWhenTheyListenAgain) {
  Windows windows;
  const std::string only = windows.open().name;
  windows.begin_listening(only);
  windows.end_listening(only);
  EXPECT_EQ(windows.close_silent(only), "");
  windows.begin_listening(only);
  EXPECT_TRUE(windows.is_open(only));
  EXPECT_TRUE(windows.is_writer(only));
  windows.begin_listening("w7-of-another-run");
  EXPECT_EQ(windows.close_silent("w7-of-another-run"), std::nullopt);
}

}  // namespace
}  // namespace pcednet::annotate
