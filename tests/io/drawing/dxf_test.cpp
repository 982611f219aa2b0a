#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <sstream>
#include <utility>

#include "io/drawing/sample_curves.h"
#include "io/scratch.h"
#include "pcednet/io/drawing/drawing.h"

namespace pcednet::io {
namespace {

using lines::Curve;

/// What follows a group code 0 up to the next.
struct DxfObject {
  std::string type, section, table;
  std::multimap<int, std::string> values;

  std::string text(int code) const {
    const auto found = values.find(code);
    return found == values.end() ? "" : found->second;
  }
  double number(int code) const { return std::stod(text(code)); }
  Vec3 point(int code) const { return {number(code), number(code + 10), number(code + 20)}; }
};

/// Every object of a DXF file; the test fails where codes and values do not alternate.
std::vector<DxfObject> parse_dxf(const std::string& bytes) {
  std::istringstream file(bytes);
  std::vector<DxfObject> objects;
  std::string section, table;
  for (std::string code, value; std::getline(file, code) && std::getline(file, value);) {
    EXPECT_NE(code.find_first_of("0123456789"), std::string::npos) << code;
    const int number = std::stoi(code);
    if (number == 0) objects.push_back({value, section, table, {}});
    if (objects.empty()) continue;
    if (value == "ENDSEC") section.clear();
    objects.back().values.emplace(number, value);
    const bool is_name = number == 2 && objects.back().values.count(2) == 1;
    if (objects.back().type == "SECTION" && is_name) section = value;
    if (objects.back().type == "TABLE" && is_name) table = value;
  }
  EXPECT_EQ(objects.back().type, "EOF");
  return objects;
}

std::vector<DxfObject> written(const Scratch& scratch, const std::vector<Curve>& curves,
                               DrawingOptions options = {}) {
  options.overwrite = Overwrite::kYes;
  write_drawing(scratch.path("a.dxf"), curves, options);
  return parse_dxf(bytes_of(scratch.path("a.dxf")));
}

std::vector<DxfObject> entities(const std::vector<DxfObject>& objects) {
  std::vector<DxfObject> found;
  for (const DxfObject& object : objects) {
    if (object.section == "ENTITIES" && object.type != "ENDSEC") {
      found.push_back(object);
    }
  }
  return found;
}

/// Where an ARC or CIRCLE of the file is at an angle in degrees: the arbitrary axis algorithm as
/// the DXF reference words it, in plain numbers.
Vec3 place_on(const DxfObject& round, double degrees) {
  const double nx = round.number(210), ny = round.number(220), nz = round.number(230);
  double ax, ay, az;
  if (std::fabs(nx) < 1.0 / 64.0 && std::fabs(ny) < 1.0 / 64.0) {
    ax = nz, ay = 0.0, az = -nx;  // (0, 1, 0) x N
  } else {
    ax = -ny, ay = nx, az = 0.0;  // (0, 0, 1) x N
  }
  const double length = std::sqrt(ax * ax + ay * ay + az * az);
  ax /= length, ay /= length, az /= length;
  const double bx = ny * az - nz * ay, by = nz * ax - nx * az, bz = nx * ay - ny * ax;
  const double angle = degrees * std::numbers::pi / 180.0, radius = round.number(40);
  const double u = round.number(10) + radius * std::cos(angle);
  const double v = round.number(20) + radius * std::sin(angle), w = round.number(30);
  return {u * ax + v * bx + w * nx, u * ay + v * by + w * ny, u * az + v * bz + w * nz};
}

const std::vector<Vec3> kAxes = {
    {0, 0, 1},           {0, 0, -1},      {1, 0, 0},         {0, -1, 0},         {1, 2, 3},
    {-1, 0.5, -2},       {1, 1, 0},       {0.0156, 0, 1},    {0.0157, 0, 1},     {0, 0.0156, -1},
    {-0.0157, 0.01, -1}, {-3, 0.001, .1}, {1e-9, -1e-12, 1}, {1e-200, 0.02, 1.0}};

TEST(Dxf, ArcsAndCirclesOfAnyPlaneAreWhereTheyWere) {
  const Scratch scratch;
  for (const double far : {0.0, 5.4e6}) {
    std::vector<Curve> curves;
    for (const Vec3& axis : kAxes) {
      const Vec3 centre(far + 1.0, 2.0 - far, 3.0);
      curves.push_back(make_arc(centre, axis, 2.5, 0.7, 4.0));
      curves.push_back(make_arc(centre, axis, 2.5, 2.0, 0.01));
      curves.push_back(make_circle(centre, axis, 0.5));
    }
    const double tolerance = far > 0.0 ? 5e-9 : 1e-14;
    for (const DxfVersion version : {DxfVersion::kR12, DxfVersion::k2000}) {
      const auto found = entities(written(scratch, curves, {.dxf_version = version}));
      ASSERT_EQ(found.size(), curves.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (curves[i].closed) {
          EXPECT_EQ(found[i].type, "CIRCLE");
          // The plane has no first direction: half a turn apart two points have the centre between.
          EXPECT_LT(
              (0.5 * (place_on(found[i], 10) + place_on(found[i], 190)) - curves[i].centre).norm(),
              tolerance);
          EXPECT_LT(std::abs((place_on(found[i], 77) - curves[i].centre).dot(curves[i].axis)),
                    tolerance);
          continue;
        }
        EXPECT_EQ(found[i].type, "ARC");
        const double from = found[i].number(50), to = found[i].number(51);
        const double span = to > from ? to - from : to - from + 360.0;
        const bool turned = found[i].point(210).dot(curves[i].axis) < 0.0;
        EXPECT_LT((place_on(found[i], turned ? to : from) - curves[i].points[0]).norm(), tolerance);
        EXPECT_LT((place_on(found[i], turned ? from : to) - curves[i].points[1]).norm(), tolerance);
        EXPECT_NEAR(span, angle_of(curves[i]) * 180.0 / std::numbers::pi, 1e-6);
        const Vec3 middle =
            curves[i].centre + Eigen::AngleAxisd(0.5 * angle_of(curves[i]), curves[i].axis) *
                                   (curves[i].points[0] - curves[i].centre);
        EXPECT_LT((place_on(found[i], from + 0.5 * span) - middle).norm(), 2 * tolerance);
      }
    }
  }
}

/// The vertices of the POLYLINE that is object `at`.
std::vector<Vec3> vertices_after(const std::vector<DxfObject>& objects, std::size_t at) {
  std::vector<Vec3> points;
  while (objects[++at].type == "VERTEX") points.push_back(objects[at].point(10));
  return points;
}

TEST(Dxf, TiltedArcsBecomePolylinesForProgramsThatTakeAllForFlat) {
  const Scratch scratch;
  const Vec3 centre(500123.25, 5400987.5, 252.125);
  const std::vector<Curve> curves = {
      make_circle(centre, Vec3(1e-5, 0, -1), 2.0),
      make_arc(centre, Vec3(0, 1e-5, -1), 2.0, 0.5, 1.5),
      make_arc(centre, Vec3(1, 2, 3), 2.0, 0.5, 1.5, kSmoothEdge),
      make_circle(centre, Vec3(0.01, 0, 1), 2.0),
  };
  for (const DxfVersion version : {DxfVersion::kR12, DxfVersion::k2000}) {
    DrawingOptions options{.tolerance = 1e-3, .dxf_version = version, .dxf_arcs = DxfArcs::kFlat};
    EXPECT_EQ(count_tilted(curves, options), 2u);
    const auto flat = entities(written(scratch, curves, options));
    EXPECT_EQ(flat[0].type, "CIRCLE");
    EXPECT_EQ(flat[1].type, "ARC");
    for (const std::size_t i : {0, 1}) {
      EXPECT_EQ(flat[i].point(10), centre);  // in the axes of the world, too
      EXPECT_EQ(flat[i].point(210), Vec3::UnitZ());
    }
    EXPECT_LT((place_on(flat[1], flat[1].number(50)) - curves[1].points[1]).norm(), 1e-4);
    EXPECT_LT((place_on(flat[1], flat[1].number(51)) - curves[1].points[0]).norm(), 1e-4);
    ASSERT_EQ(flat[2].type, "POLYLINE");
    EXPECT_EQ(flat[2].text(8), "smooth-edge");
    EXPECT_EQ(flat[2].text(70), "8");
    const auto arc = vertices_after(flat, 2);
    EXPECT_EQ(arc.front(), curves[2].points.front());
    EXPECT_EQ(arc.back(), curves[2].points.back());
    for (const Vec3& point : arc) EXPECT_NEAR((point - centre).norm(), 2.0, 1e-6);
    const std::size_t last = 2 + arc.size() + 2;
    ASSERT_EQ(flat[last].type, "POLYLINE");
    EXPECT_EQ(flat[last].text(70), "9");
    const auto circle = vertices_after(flat, last);
    EXPECT_NE(circle.front(), circle.back());
    options.dxf_arcs = DxfArcs::kNone;
    for (const DxfObject& object : entities(written(scratch, curves, options))) {
      EXPECT_TRUE(object.type != "ARC" && object.type != "CIRCLE") << object.type;
    }
  }
}

TEST(Dxf, NormalsOfOppositeAxesAreAlikeAndPointUpwards) {
  const Scratch scratch;
  for (const Vec3& axis : kAxes) {
    const Vec3 centre(7.0, -4.0, 3.0);
    const Curve arc = make_arc(centre, axis, 2.5, 0.7, 4.0);
    Curve reversed = arc;
    reversed.axis = -arc.axis;
    std::swap(reversed.points[0], reversed.points[1]);
    const auto found = entities(written(scratch, {arc, reversed}));
    EXPECT_EQ(found.at(0).point(210), found.at(1).point(210)) << axis.transpose();
    EXPECT_GT(found[0].number(230), -1.0 / 64.0) << axis.transpose();
    for (const int code : {10, 20, 30, 50, 51}) {
      EXPECT_EQ(found[0].text(code), found[1].text(code)) << axis.transpose();
    }
  }
  // The ends of a horizontal bore, each with the noise of its fit.
  const auto bore =
      entities(written(scratch, {make_circle(Vec3::Zero(), Vec3(1, 2e-3, -1e-3), 2.0),
                                 make_circle(Vec3::UnitX(), Vec3(-1, 1e-3, -2e-3), 2.0)}));
  EXPECT_GT(bore.at(0).point(210).dot(bore.at(1).point(210)), 0.99);
}

TEST(Dxf, FlatArcsKeepEveryBitOfTheirCentre) {
  const Scratch scratch;
  const Vec3 centre(500123.456789, 5400987.654321, 0.1);
  const auto found = entities(written(scratch, {make_circle(centre, Vec3::UnitZ(), 2.0)}));
  EXPECT_EQ(found.at(0).point(10), centre);
  const auto turned = entities(written(scratch, {make_circle(centre, -Vec3::UnitZ(), 2.0)}));
  EXPECT_EQ(turned.at(0).point(10), centre);
}

TEST(Dxf, KeepsEveryBitOfLinesOnTheirLayers) {
  const Scratch scratch;
  const auto curves = sample_curves();
  for (const DxfVersion version : {DxfVersion::kR12, DxfVersion::k2000}) {
    const auto found = entities(written(scratch, curves, {.dxf_version = version}));
    std::vector<std::string> types;
    for (const DxfObject& entity : found) types.push_back(entity.type);
    EXPECT_EQ(types, (std::vector<std::string>{"LINE", "POLYLINE", "VERTEX", "VERTEX", "VERTEX",
                                               "SEQEND", "POLYLINE", "VERTEX", "VERTEX", "VERTEX",
                                               "SEQEND", "ARC", "CIRCLE"}));
    EXPECT_EQ(found[0].point(10), curves[0].points[0]);
    EXPECT_EQ(found[0].point(11), curves[0].points[1]);
    for (std::size_t v = 0; v < 3; ++v) {
      EXPECT_EQ(found[2 + v].point(10), curves[1].points[v]);
      EXPECT_EQ(found[7 + v].point(10), curves[2].points[v]);
      EXPECT_EQ(found[2 + v].text(70), "32");
    }
    EXPECT_EQ(found[1].text(70), "9");
    EXPECT_EQ(found[6].text(70), "8");
    const std::vector<std::string> layers = {"sharp-edge", "smooth-edge", "boundary", "smooth-edge",
                                             "sharp-edge"};
    const std::size_t first[] = {0, 1, 6, 11, 12};
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(found[first[i]].text(8), layers[i]);
      EXPECT_EQ(found[first[i]].text(1001), "PCEDNET");
    }
    // Values of one code stand in the order of the file.
    const auto names = found[0].values.equal_range(1000),
               numbers = found[0].values.equal_range(1040);
    EXPECT_EQ(names.first->second, "confidence");
    EXPECT_EQ(std::next(names.first)->second, "dihedral_angle");
    EXPECT_EQ(numbers.first->second, "0.9375");
    EXPECT_EQ(std::next(numbers.first)->second, "90.0");
  }
}

std::set<std::string> names_in(const std::vector<DxfObject>& objects, const std::string& table) {
  std::set<std::string> names;
  for (const DxfObject& object : objects) {
    if (object.table == table && object.type == table) names.insert(object.text(2));
  }
  return names;
}

TEST(Dxf, HasWhatItsVersionMustHave) {
  const Scratch scratch;
  const auto old = written(scratch, sample_curves(), {.dxf_version = DxfVersion::kR12});
  EXPECT_TRUE(contains(bytes_of(scratch.path("a.dxf")), "AC1009"));
  for (const DxfObject& object : old) {
    EXPECT_EQ(object.values.count(5) + object.values.count(100) + object.values.count(330), 0u)
        << object.type;
  }
  EXPECT_EQ(names_in(old, "APPID").count("PCEDNET"), 1u);
  const auto layers = names_in(old, "LAYER");
  EXPECT_EQ(layers, (std::set<std::string>{"0", "sharp-edge", "smooth-edge", "boundary"}));

  const auto current = written(scratch, sample_curves(), {.unit = LengthUnit::kMetre});
  const std::string bytes = bytes_of(scratch.path("a.dxf"));
  EXPECT_TRUE(contains(bytes, "AC1015"));
  EXPECT_TRUE(contains(bytes, "$INSUNITS\n 70\n6\n"));
  EXPECT_EQ(names_in(current, "LAYER"), layers);
  for (const char* table : {"VPORT", "LTYPE", "STYLE", "APPID", "DIMSTYLE", "BLOCK_RECORD"}) {
    EXPECT_FALSE(names_in(current, table).empty()) << table;
  }
  std::set<std::string> handles, owners;
  std::size_t objects = 0;
  std::uint64_t seed = 0;
  for (const DxfObject& object : current) {
    const bool is_header = object.section == "HEADER" || object.type == "SECTION";
    if (object.type == "SECTION" && object.text(2) == "HEADER") {
      seed = std::stoull(object.text(5), nullptr, 16);
    }
    const std::string handle = object.text(object.type == "DIMSTYLE" ? 105 : 5);
    if (is_header || handle.empty()) continue;
    ++objects;
    handles.insert(handle);
    owners.insert(object.text(330));
    EXPECT_LT(std::stoull(handle, nullptr, 16), seed);
  }
  EXPECT_EQ(handles.size(), objects);
  owners.erase("0");
  for (const std::string& owner : owners) EXPECT_TRUE(handles.contains(owner)) << owner;
}

TEST(Dxf, HasTheUnitOfTheCoordinateSystem) {
  const Scratch scratch;
  const auto written_unit = [&](LengthUnit unit, std::optional<LengthUnit> given = {}) {
    written(scratch, sample_curves(), {.unit = given, .coordinate_system = {.unit = unit}});
    const std::string bytes = bytes_of(scratch.path("a.dxf"));
    const auto number_after = [&](std::string_view variable) {
      return std::stoi(bytes.substr(bytes.find(variable) + variable.size()));
    };
    return std::pair(number_after("$INSUNITS\n 70\n"), number_after("$MEASUREMENT\n 70\n"));
  };
  EXPECT_EQ(written_unit(LengthUnit::kMetre), std::pair(6, 1));
  EXPECT_EQ(written_unit(LengthUnit::kFoot), std::pair(2, 0));
  EXPECT_EQ(written_unit(LengthUnit::kUsSurveyFoot), std::pair(21, 0));
  EXPECT_EQ(written_unit(LengthUnit::kNone), std::pair(0, 1));
  EXPECT_EQ(written_unit(LengthUnit::kFoot, LengthUnit::kMetre), std::pair(6, 1));
  EXPECT_EQ(written_unit(LengthUnit::kFoot, LengthUnit::kNone), std::pair(0, 1));
}

TEST(Dxf, AWholeTurnIsACircle) {
  const Scratch scratch;
  Curve arc = make_arc(Vec3::Zero(), Vec3::UnitX(), 1.0, 0.0, 1.0);
  arc.points[1] = arc.points[0];
  EXPECT_EQ(entities(written(scratch, {arc})).at(0).type, "CIRCLE");
}

}  // namespace
}  // namespace pcednet::io
