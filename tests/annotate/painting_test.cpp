#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "pcednet/core/error.h"
#include "pcednet/core/random_vectors.h"
#include "support/expect_error.h"
#include "support/own_folder.h"
#include "workbench/annotate/project/journal.h"
#include "workbench/annotate/project/painting.h"
#include "workbench/annotate/scene/select.h"

namespace pcednet::annotate {
namespace {

namespace fs = std::filesystem;

/// Two parallel sheets that face away from each other, 0.02 apart, about `origin`.
struct Sheets {
  std::vector<Vec3> positions = {}, normals = {};
  explicit Sheets(const Vec3& origin = Vec3::Zero()) {
    for (int i = 0; i < 100; ++i) {
      for (int j = 0; j < 100; ++j) {
        for (const double side : {1.0, -1.0}) {
          positions.push_back(origin + Vec3(0.01 * i - 0.495, 0.01 * j - 0.495, 0.01 * side));
          normals.push_back(Vec3(0, 0, side));
        }
      }
    }
  }
};

TEST(Select, TheBrushPaintsTheSideItTouchesOnly) {
  const Vec3 origin(1e6, -2e6, 50);
  const Sheets sheets(origin);
  const Selector selector(sheets.positions, sheets.normals, origin, 0.01);
  Stroke stroke;
  stroke.centres = {Vec3(0, 0, 0.012), Vec3(0.1, 0, 0.012)};
  stroke.radius = 0.1;
  const auto found = selector.select(stroke);
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < sheets.positions.size(); ++i) {
    const Vec3 p = sheets.positions[i] - origin;
    const bool near = (p - stroke.centres[0]).norm() < 0.1 || (p - stroke.centres[1]).norm() < 0.1;
    if (near && sheets.normals[i].z() > 0) expected.push_back(i);
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(found, expected);
}

/// A view along -z, orthographic or in perspective from z = 2.
std::array<double, 16> view_matrix(bool perspective) {
  if (!perspective) return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
  // near 0.1, far 10, 90 degrees; then moved by -2 along z.
  const double a = -10.1 / 9.9, b = -2.0 / 9.9;
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, a, -1, 0, 0, -2 * a + b, 2};
}

TEST(Select, APolygonPaintsWhatIsWithinItAndInFront) {
  // The sheets are half a unit apart here: the far one is hidden by the near one.
  Sheets sheets;
  for (Vec3& p : sheets.positions) p.z() *= 25;
  const Selector selector(sheets.positions, sheets.normals, Vec3::Zero(), 0.012);
  for (const bool perspective : {false, true}) {
    Stroke stroke;
    stroke.tool = Tool::kPolygon;
    stroke.polygon = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}};
    stroke.matrix = view_matrix(perspective);
    stroke.viewport = {800, 800};
    const auto all = selector.select(stroke);
    const auto is_front = [&](std::uint32_t i) { return sheets.normals[i].z() > 0; };
    std::vector<std::uint32_t> front;
    std::copy_if(all.begin(), all.end(), std::back_inserter(front), is_front);
    EXPECT_GT(front.size(), 300u);
    EXPECT_GT(all.size(), front.size() + 300);
    stroke.front_only = true;
    EXPECT_EQ(selector.select(stroke), front) << perspective;
    stroke.clip = BoundingBox{.min = Vec3(0, -9, -9), .max = Vec3(9, 9, 9)};
    std::erase_if(front, [&](std::uint32_t i) { return sheets.positions[i].x() < 0; });
    EXPECT_GT(front.size(), 150u);
    EXPECT_EQ(selector.select(stroke), front) << perspective;
  }
}

TEST(Labels, UndoAndRedoLeadBackAndForth) {
  Random random(3);
  Labels labels(50);
  std::vector<std::vector<std::uint8_t>> states = {labels.classes()};
  for (int step = 0; step < 20; ++step) {
    std::vector<std::uint32_t> points;
    for (std::uint32_t i = 0; i < 50; ++i) {
      if (random.uniform() < 0.3) points.push_back(i);
    }
    const std::size_t c = random.index(4);
    labels.paint(c == 3 ? std::uint8_t{255} : static_cast<std::uint8_t>(c), points);
    states.push_back(labels.classes());
  }
  for (std::size_t i = 20; i-- > 0;) {
    labels.undo();
    EXPECT_EQ(labels.classes(), states[i]);
  }
  EXPECT_EQ(labels.counts(), (std::array<std::size_t, kMostClasses>{}));
  EXPECT_TRUE(labels.undo().empty());
  for (std::size_t i = 1; i <= 20; ++i) {
    labels.redo();
    EXPECT_EQ(labels.classes(), states[i]);
  }
  labels.undo();
  labels.paint(1, {0});
  EXPECT_EQ(labels.redo_steps(), 0u);
}

TEST(Labels, ProtectedAndHiddenPointsKeepWhatTheyHave) {
  const std::vector<std::uint8_t> labels = {255, 0, 1, 2, 255};
  const std::vector<std::uint8_t> prediction = {0, 0, 0, 0, 1};
  Stroke stroke;
  stroke.edge_class = 2;
  EXPECT_EQ(points_to_change({0, 1, 2, 3, 4}, stroke, labels, {}),
            (std::vector<std::uint32_t>{0, 1, 2, 4}));
  stroke.hidden = {1};
  EXPECT_EQ(points_to_change({0, 1, 2, 3, 4}, stroke, labels, prediction),
            (std::vector<std::uint32_t>{0, 1}));
  stroke.protect = true;
  EXPECT_EQ(points_to_change({0, 1, 2, 3, 4}, stroke, labels, prediction),
            (std::vector<std::uint32_t>{0}));
}

class JournalTest : public testing::Test, protected test::OwnFolder {
 protected:
  static std::vector<std::string> lines(const std::vector<Record>& records) {
    std::vector<std::string> result;
    for (const Record& record : records) result.push_back(to_line(record));
    return result;
  }

  const std::filesystem::path path_ = path("a.journal");
  const Inputs input_ = {{.name = "a.ply", .digest = "d", .points = 100}};
  std::vector<Record> records_ = {
      {.kind = Record::Kind::kStroke, .id = "s\"1", .edge_class = 2, .points = {0, 7, 99}},
      {.kind = Record::Kind::kUndo},
      {.kind = Record::Kind::kRedo},
      {.kind = Record::Kind::kSettings, .settings = {.classes = 2, .start = "cad", .seed = 9}},
      {.kind = Record::Kind::kRun, .run = {.number = 3, .records = 1, .settings = {.seed = 9}}},
      {.kind = Record::Kind::kRestore, .run = {.number = 3}}};
};

TEST_F(JournalTest, KeepsEveryWholeLineWhereverItsEndIsLost) {
  {
    std::vector<Record> none;
    Journal journal(path_, input_, none);
    for (const Record& record : records_) journal.append(record);
  }
  std::ifstream file(path_, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  for (std::size_t size = 0; size <= text.size(); ++size) {
    std::ofstream(path_, std::ios::binary) << text.substr(0, size);
    std::vector<Record> found;
    Journal(path_, input_, found).append(records_[1]);
    const auto whole =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size), '\n');
    auto expected = lines(records_);
    expected.resize(static_cast<std::size_t>(std::max<std::ptrdiff_t>(whole - 1, 0)));
    EXPECT_EQ(lines(found), expected) << size;
    std::vector<Record> again;
    const Journal reopened(path_, input_, again);
    expected.push_back(to_line(records_[1]));
    EXPECT_EQ(lines(again), expected) << size;
  }
}

TEST_F(JournalTest, StaysAsItIsWhereItCannotBeRead) {
  {
    std::vector<Record> known = records_;
    const Journal journal(path_, input_, known);
  }
  const auto size = std::filesystem::file_size(path_);
  // One more file can be open: the journal itself, but none to read it by.
  const int next = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::close(next);
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit few = before;
  few.rlim_cur = static_cast<rlim_t>(next) + 1;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  std::vector<Record> found;
  EXPECT_ERROR(ErrorKind::kUnreadable, Journal(path_, input_, found));
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(std::filesystem::file_size(path_), size);
}

TEST_F(JournalTest, RefusesWhatIsDamagedOrOfAnotherInput) {
  {
    std::vector<Record> known = records_;
    const Journal journal(path_, input_, known);
    std::vector<Record> second;
    EXPECT_ERROR(ErrorKind::kFailure, Journal(path_, input_, second));  // one annotator at a time
  }
  std::vector<Record> found;
  EXPECT_ERROR(ErrorKind::kInsufficient,
               Journal(path_, {{.name = "b", .digest = "e", .points = 100}}, found));
  EXPECT_ERROR(ErrorKind::kUnreadable,
               Journal(path_, {{.name = "a", .digest = "d", .points = 99}}, found));
  for (const char* line :
       {R"({"stroke":"x","class":8,"points":[]})", R"([1])", "{}", "",
        R"({"stroke":"x","class":1,"points":[5,0]})", R"({"stroke":"x","class":1,"points":[-1]})",
        R"({"stroke":"x","class":1,"points":[18446744073709551615,2]})"}) {
    EXPECT_ERROR(ErrorKind::kUnreadable, parse_record(line, 100)) << line;
  }
}

/// The words of the error that `statement` throws.
template <typename Statement>
std::string words_of(const Statement& statement) {
  const auto error = test::error_of(statement);
  return error ? error->what() : "no error";
}

class DamagedJournal : public JournalTest {
 protected:
  DamagedJournal() {
    std::vector<Record> known = records_;
    const Journal journal(path_, input_, known);
    std::ifstream file(path_, std::ios::binary);
    text_.assign(std::istreambuf_iterator<char>(file), {});
  }

  void write(const std::string& text) { std::ofstream(path_, std::ios::binary) << text; }

  std::vector<Record> read() {
    std::vector<Record> found;
    const Journal journal(path_, input_, found);
    return found;
  }

  std::string text_ = {};
};

TEST_F(DamagedJournal, NamesTheFileTheLineAndWhatToDo) {
  const std::string mend =
      "; to keep the strokes before it, copy the journal to a safe place, then "
      "delete from line ";
  const auto is_told = [&](const std::string& words, std::size_t line, const std::string& why) {
    const std::string number = std::to_string(line);
    EXPECT_TRUE(words.starts_with(path_.string() + ": line " + number + ": " + why)) << words;
    EXPECT_NE(words.find(mend + number + " to the end"), words.npos) << words;
  };
  std::string bad = text_;
  bad.insert(bad.find("{\"redo\""), "xx");
  write(bad);
  is_told(words_of([&] { read(); }), 4, "parse error at column ");
  write(text_ + "\n" + R"({"stroke":"x","class":7,"points":[1]})" + "\n");
  is_told(words_of([&] { read(); }), records_.size() + 3, "a stroke of class 7");
  for (const std::string& head : {std::string("xx\n"), text_.substr(10), "\n" + text_}) {
    write(head);
    for (const std::string& words :
         {words_of([&] { read(); }), words_of([&] { inputs_of_journal(path_); })}) {
      EXPECT_TRUE(words.starts_with(path_.string() + ": line 1: ")) << words;
      EXPECT_NE(words.find("; move the journal away to start afresh"), words.npos) << words;
    }
  }
}

TEST_F(DamagedJournal, OpensWithBlankLinesAndATornEnd) {
  const std::string nul(5, '\0');
  for (const std::string& end : {std::string("\n"), std::string("\r\n \n"), nul, nul + "\n",
                                 std::string("\n{\"stroke\":\"x\",\"cla")}) {
    write(text_ + end);
    EXPECT_EQ(lines(read()), lines(records_));
  }
  write(text_.substr(0, 20));  // ended while its first line was written
  EXPECT_TRUE(inputs_of_journal(path_).empty());
  EXPECT_TRUE(read().empty());
}

/// Strokes of a project in a folder of its own.
class PaintingTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directory(folder_);
    painting_.emplace(folder_ / "a.json", input_);
    paint("first");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void paint(const std::string& id) {
    painting_->add({.id = id, .edge_class = 2, .points = {strokes_++}});
  }

  std::size_t kept() {
    painting_.reset();  // which lets go of the journal
    return Painting(folder_ / "a.json", input_).records().size();
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) /
      ("pcednet_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  const fs::path journal_ = folder_ / "a.json.journal";
  const Inputs input_ = {{.name = "a.ply", .digest = "d", .points = 100}};
  std::optional<Painting> painting_ = {};
  std::uint32_t strokes_ = 0;
};

TEST_F(PaintingTest, WritesADeletedJournalAgain) {
  fs::remove(journal_);
  paint("second");
  paint("third");
  EXPECT_EQ(kept(), 3u);
}

TEST_F(PaintingTest, RefusesStrokesWhileItsFolderIsGone) {
  fs::remove_all(folder_);
  EXPECT_ERROR(ErrorKind::kFailure, paint("second"));
  EXPECT_EQ(painting_->records().size(), 1u);
  fs::create_directory(folder_);
  paint("third");
  EXPECT_EQ(kept(), 2u);
}

TEST_F(PaintingTest, WritesIntoNoOtherFileInThePlaceOfItsJournal) {
  fs::rename(journal_, folder_ / "moved");
  std::ofstream(journal_) << "mine\n";
  EXPECT_ERROR(ErrorKind::kFailure, paint("second"));
  EXPECT_EQ(fs::file_size(journal_), 5u);
  fs::remove(journal_);
  paint("third");
  EXPECT_EQ(kept(), 2u);
}

TEST_F(PaintingTest, SaysWhatIsWrongWithAProjectAndWhatToDo) {
  painting_.reset();
  fs::remove(journal_);
  std::ofstream(folder_ / "a.json") << "{";
  try {
    Painting(folder_ / "a.json", input_);
    FAIL();
  } catch (const Error& error) {
    const std::string words = error.what();
    EXPECT_EQ(words.find("json.exception"), words.npos) << words;
    EXPECT_NE(words.find("; move it away to start afresh"), words.npos) << words;
  }
}

TEST_F(PaintingTest, NamesTheProjectAndTheRecordOfAnUnknownClass) {
  painting_.reset();
  fs::remove(journal_);
  const fs::path project = folder_ / "a.json";
  const Record sound = {.id = "a", .edge_class = 2, .points = {1}};
  write_project(project, {.inputs = input_, .records = {sound}}, Overwrite::kNo);
  std::ifstream file(project);
  std::string text(std::istreambuf_iterator<char>(file), {});
  text.replace(text.find("\"class\":2"), 9, "\"class\":7");
  std::ofstream(project) << text;
  const std::string words = words_of([&] { Painting(project, input_); });
  EXPECT_TRUE(words.starts_with(project.string() + ": no project: record 1: a stroke of class 7"))
      << words;
}

TEST(Places, AreTheLeastCertainAndApart) {
  Random random(5);
  std::vector<Vec3> points(2000);
  std::vector<float> confidence;
  for (Vec3& p : points) {
    p = uniform_vector(random);
    confidence.push_back(static_cast<float>(random.uniform()));
  }
  const auto places = rank_uncertain(points, spatial::KdTree(points), confidence, 0.2, 10);
  ASSERT_EQ(places.size(), 10u);
  EXPECT_EQ(places[0], std::min_element(confidence.begin(), confidence.end()) - confidence.begin());
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE((points[places[i]] - points[places[j]]).norm(), 0.2);
      EXPECT_LE(confidence[places[j]], confidence[places[i]]);
    }
  }
}

TEST(Places, PickTakesTheFirstPointAlongTheRay) {
  const std::vector<Vec3> points = {{0, 0, -1}, {0.05, 0, 3}, {0, 0, 5}, {1, 0, 2}};
  const auto found = pick(points, Vec3::Zero(), Vec3(0, 0, 9), 0.1);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->point, 1u);
  EXPECT_DOUBLE_EQ(found->distance, 3.0);
  EXPECT_FALSE(pick(points, Vec3::Zero(), Vec3(0, 1, 0), 0.01));
}

}  // namespace
}  // namespace pcednet::annotate
