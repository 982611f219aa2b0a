#include "pcednet/formats/format.h"

#include <gtest/gtest.h>

#include "io/scratch.h"

namespace pcednet::formats {
namespace {

TEST(Formats, AreListedByTheirExtensions) {
  EXPECT_EQ(extensions_read(),
            ".ply .pcd .las .laz .copc.laz .e57 .ptx .obj .off .stl .xyz .txt .asc .pts .csv");
  EXPECT_EQ(extensions_written(" or "),
            ".ply .pcd .las .laz .copc.laz .obj .xyz .txt .asc .pts or .csv");
}

TEST(Formats, AreFoundByTheExtensionInAnyCase) {
  ASSERT_NE(find_format("folder.ply/A.LaZ"), nullptr);
  EXPECT_EQ(find_format("folder.ply/A.LaZ")->name, "LAS");
  EXPECT_EQ(find_format("folder.ply/a"), nullptr);
  EXPECT_EQ(find_format("a.step"), nullptr);
}

TEST(Formats, GiveWayToTheNameOfAFile) {
  EXPECT_EQ(stem_of("folder.ply/a.b.laz"), "a.b");
  EXPECT_EQ(stem_of("a.copc.laz"), "a");
  EXPECT_EQ(stem_of("b/A.COPC.LAZ"), "A");
  EXPECT_EQ(stem_of("a.copc.las"), "a.copc");
  EXPECT_EQ(stem_of("a"), "a");
}

TEST(Formats, AreWrittenOnlyIfTheyHaveAWriter) {
  EXPECT_EQ(format_for("a.csv").name, "text");
  const auto refusal = [](const char* name) {
    return io::error_of(ErrorKind::kUsage, [&] { format_for(name); });
  };
  EXPECT_EQ(refusal("a.e57"), "a.e57: points are written as " + extensions_written());
  EXPECT_EQ(refusal("a"), "a: points are written as " + extensions_written());
}

TEST(Formats, AreEachToldByTheirOwnBeginning) {
  const io::Scratch scratch;
  for (const auto& [start, name] : {std::pair("ply\n", "PLY"), std::pair("# .PCD v0.7", "PCD"),
                                    std::pair("LASF", "LAS"), std::pair("ASTM-E57", "E57")}) {
    EXPECT_EQ(format_of(io::InputFile(scratch.file("a.xyz", start))).name, name);
  }
}

}  // namespace
}  // namespace pcednet::formats
