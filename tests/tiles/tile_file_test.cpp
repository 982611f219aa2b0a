#include "pcednet/tiles/tile_file.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::tiles {
namespace {

class TileFile : public testing::Test, protected test::OwnFolder {};

TEST_F(TileFile, ThatIsGoneGetsNoRecord) {
  EXPECT_ERROR(ErrorKind::kUnreadable, write_record(folder_ / "0.ply", {}));
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace pcednet::tiles
