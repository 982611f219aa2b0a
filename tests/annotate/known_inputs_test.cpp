#include "workbench/annotate/project/known_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "pcednet/core/error.h"
#include "support/expect_error.h"
#include "support/own_folder.h"
#include "workbench/annotate/project/painting.h"

namespace pcednet::annotate {
namespace {

namespace fs = std::filesystem;

/// A project of two inputs with a stroke in each, in a folder of its own.
class KnownInputs : public testing::Test, protected test::OwnFolder {
 protected:
  KnownInputs() {
    Painting painting(project_, inputs_);
    painting.add({.id = "first", .edge_class = 2, .points = {1}});
    painting.add({.id = "second", .edge_class = 0, .points = {150}});
  }

  /// What is said of `inputs` in place of those that were painted.
  std::string said_of(const Inputs& inputs) const {
    const auto error = test::error_of([&] { Painting(project_, inputs); });
    if (!error) return "nothing";
    EXPECT_EQ(error->kind(), ErrorKind::kInsufficient);
    return error->what();
  }

  const fs::path project_ = folder_ / "a.json";
  const std::string journal_ = journal_of(project_).string();
  const Inputs inputs_ = {{.name = "a.ply", .digest = "first", .points = 100},
                          {.name = "more/b.ply", .digest = "second", .points = 200}};
};

TEST_F(KnownInputs, HaveTheNamesOfTheirLastPlaces) {
  Inputs moved = inputs_;
  moved[1].name = "elsewhere/c.ply";
  EXPECT_EQ(Painting(project_, moved).records().size(), 2u);
  EXPECT_EQ(inputs_of_project(project_), moved);
  EXPECT_EQ(Painting(project_, moved).labels().painted(), 2u);
}

TEST_F(KnownInputs, ThatChangedAreNamedWithWhatToDo) {
  Inputs others = inputs_;
  others[1].digest = "changed";
  const std::string mend =
      ": put back the file that was painted, or start afresh with --project FILE, which keeps "
      "these strokes as they are";
  EXPECT_EQ(said_of(others), journal_ + ": cloud 2 of 2, more/b.ply, is another input now" + mend);
  others[1].name = "c.ply";
  EXPECT_EQ(said_of(others),
            journal_ + ": cloud 2 of 2, more/b.ply, is another input now, c.ply" + mend);
  EXPECT_EQ(said_of({inputs_[1], inputs_[0]}),
            journal_ +
                ": cloud 1 of 2, a.ply, has another place here: name the clouds in their "
                "order");
  EXPECT_EQ(said_of({inputs_[0]}), journal_ + ": of 2 clouds, here are 1: name all in their order");
  EXPECT_EQ(Painting(project_, inputs_).records().size(), 2u) << "the strokes are still there";
}

TEST_F(KnownInputs, OfASavedProjectAreHeldAgainstItToo) {
  write_project(project_, {.inputs = inputs_, .records = {}}, Overwrite::kNo);
  fs::remove(journal_);
  Inputs others = inputs_;
  others[0].digest = "changed";
  EXPECT_TRUE(said_of(others).starts_with(project_.string() + ": cloud 1 of 2, a.ply, is another"));
  EXPECT_FALSE(fs::exists(journal_));
}

TEST_F(KnownInputs, ThatAreMissingAreNamedWithTheirProject) {
  const auto place = [&](const Inputs& known, std::size_t k) {
    return place_of_input(project_, known, k, folder_);
  };
  const auto error = test::error_of([&] { place(inputs_, 1); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::kUnreadable);
  const std::string b = (folder_ / "more/b.ply").string();
  EXPECT_EQ(error->what(), project_.string() + ": cloud 2 of 2, " + b +
                               ", is missing: put it back, or name all clouds in their order");
  EXPECT_ERROR(ErrorKind::kUnreadable, place({inputs_[0]}, 0));
  fs::create_directory(folder_ / "more");
  std::ofstream(folder_ / "more/b.ply") << "ply";
  EXPECT_EQ(place(inputs_, 1), folder_ / "more/b.ply");
}

}  // namespace
}  // namespace pcednet::annotate
