#include "workbench/render/preview.h"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "support/expect_error.h"
#include "support/own_folder.h"

namespace pcednet::render {
namespace {

struct Picture {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;

  template <typename Predicate>
  double share(Predicate&& predicate) const {
    return static_cast<double>(std::count_if(pixels.begin(), pixels.end(), predicate)) /
           static_cast<double>(pixels.size());
  }
};

bool is_red(const Rgb& c) {
  return c[0] > 80 && c[1] < 30 && c[2] < 30;
}
bool is_yellow(const Rgb& c) {
  return c[0] > c[1] + 20 && c[1] > c[2] + 40;
}
bool is_blue(const Rgb& c) {
  return c[2] > 80 && c[0] < 40 && c[1] < 40;
}
bool is_background(const Rgb& c) {
  return c == Rgb{255, 255, 255};
}

class Preview : public testing::Test, protected test::OwnFolder {
 protected:
  std::filesystem::path path(const std::string& name = "picture.png") const {
    return folder_ / name;
  }

  std::string bytes_of(const PointCloud& cloud, const std::vector<std::uint8_t>& classes,
                       PreviewOptions options = {.width = 160, .height = 120},
                       const std::vector<lines::Curve>& curves = {}) const {
    options.overwrite = Overwrite::kYes;
    write_preview(path(), cloud, classes, options, curves);
    std::ifstream file(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  Picture picture_of(const PointCloud& cloud, const std::vector<std::uint8_t>& classes,
                     const PreviewOptions& options = {.width = 160, .height = 120},
                     const std::vector<lines::Curve>& curves = {}) const {
    const std::string bytes = bytes_of(cloud, classes, options, curves);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
    EXPECT_EQ(image.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
    Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
    picture.pixels.resize(static_cast<std::size_t>(image.width) * image.height);
    EXPECT_TRUE(png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr));
    return picture;
  }
};

constexpr int kSteps = 32;

struct Labelled {
  PointCloud cloud;
  std::vector<std::uint8_t> classes;  ///< sharp on the edges of the cube, non-edge elsewhere
};

/// The surface of a cube on a grid, coordinates multiples of 1/16.
Labelled cube() {
  Labelled cube;
  const auto coordinate = [](int i) { return (i - kSteps / 2) / 16.0; };
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (int k = 0; k <= kSteps; ++k) {
        const int ends = (i % kSteps == 0) + (j % kSteps == 0) + (k % kSteps == 0);
        if (ends == 0) continue;
        cube.cloud.positions.emplace_back(coordinate(i), coordinate(j), coordinate(k));
        cube.classes.push_back(ends >= 2 ? kSharpEdge : kNonEdge);
      }
    }
  }
  return cube;
}

TEST_F(Preview, HasTheSizeThatWasAskedFor) {
  const Labelled shape = cube();
  for (const auto& [width, height] : {std::pair{160, 100}, std::pair{47, 123}, std::pair{1, 1}}) {
    const Picture picture =
        picture_of(shape.cloud, shape.classes, {.width = width, .height = height});
    EXPECT_EQ(picture.width, width);
    EXPECT_EQ(picture.height, height);
  }
}

TEST_F(Preview, ShowsTheEdgesOfACube) {
  Labelled shape = cube();
  EXPECT_GT(picture_of(shape.cloud, shape.classes).share(is_red), 0.02);
  EXPECT_EQ(picture_of(shape.cloud, shape.classes).share(is_yellow), 0.0);

  std::fill(shape.classes.begin(), shape.classes.end(), kNonEdge);
  EXPECT_EQ(picture_of(shape.cloud, shape.classes).share(is_red), 0.0);

  std::fill(shape.classes.begin(), shape.classes.end(), kSmoothEdge);
  EXPECT_GT(picture_of(shape.cloud, shape.classes).share(is_yellow), 0.2);
  EXPECT_EQ(picture_of(shape.cloud, shape.classes).share(is_red), 0.0);
}

TEST_F(Preview, FillsThePictureWithAClosedSurface) {
  const Labelled shape = cube();
  const Picture picture =
      picture_of(shape.cloud, {}, {.width = 480, .height = 360, .view_direction = Vec3(0, 1, 0)});
  int left = picture.width, right = 0, top = picture.height, bottom = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (is_background(picture.pixels[static_cast<std::size_t>(y * picture.width + x)])) continue;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  // The points span 88 %, and the discs on the rim reach a little over that.
  EXPECT_NEAR(bottom - top, 0.93 * picture.height, 0.05 * picture.height);
  EXPECT_NEAR(left + right, picture.width, 0.02 * picture.width);
  EXPECT_NEAR(top + bottom, picture.height, 0.02 * picture.height);
  // Square on, the cube is a square, and not a pixel within it shows the background.
  EXPECT_NEAR(right - left, bottom - top, 0.01 * picture.height);
  for (int y = top + 20; y < bottom - 20; ++y) {
    for (int x = left + 20; x < right - 20; ++x) {
      const Rgb& c = picture.pixels[static_cast<std::size_t>(y * picture.width + x)];
      ASSERT_LT(c[0], 250) << x << ' ' << y;
      ASSERT_GT(c[0], 120) << x << ' ' << y;
    }
  }
}

TEST_F(Preview, HidesWhatLiesInside) {
  const Labelled box = cube();
  PointCloud cloud;
  std::vector<std::uint8_t> classes;
  for (int i = 0; i < 2000; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / 2000.0, angle = i * std::numbers::phi * 2.0 * 3.14159;
    const double r = std::sqrt(1.0 - z * z);
    cloud.positions.emplace_back(0.8 * Vec3(r * std::cos(angle), r * std::sin(angle), z));
    classes.push_back(kSharpEdge);
  }
  EXPECT_GT(picture_of(cloud, classes).share(is_red), 0.2);
  cloud.positions.insert(cloud.positions.end(), box.cloud.positions.begin(),
                         box.cloud.positions.end());
  classes.resize(cloud.size(), kNonEdge);
  EXPECT_EQ(picture_of(cloud, classes).share(is_red), 0.0);
}

TEST_F(Preview, LooksAlongTheDirectionThatWasAskedFor) {
  // A plate whose upper side is red, its lower side, a little below, yellow.
  PointCloud cloud;
  std::vector<std::uint8_t> classes;
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) {
      cloud.positions.emplace_back(i, j, 0.0);
      cloud.positions.emplace_back(i, j, -10.0);
      classes.insert(classes.end(), {kSharpEdge, kSmoothEdge});
    }
  }
  PreviewOptions options{.width = 160, .height = 120, .view_direction = Vec3(0, 0, -3)};
  const Picture from_above = picture_of(cloud, classes, options);
  EXPECT_GT(from_above.share(is_red), 0.3);
  EXPECT_EQ(from_above.share(is_yellow), 0.0);
  options.view_direction = Vec3(0, 0, 1e-200);
  const Picture from_below = picture_of(cloud, classes, options);
  EXPECT_GT(from_below.share(is_yellow), 0.3);
}

TEST_F(Preview, LooksAtTheSideThatNormalsPointTo) {
  // Two sheets, blue in front and red behind, as seen along y.
  for (const double side : {1.0, -1.0}) {
    PointCloud cloud;
    for (int i = 0; i < 60; ++i) {
      for (int j = 0; j < 60; ++j) {
        cloud.positions.emplace_back(i, 0.0, j);
        cloud.positions.emplace_back(i, 8.0, j);
        cloud.normals.insert(cloud.normals.end(), 2, Vec3(0, side, 0));
        cloud.colours.insert(cloud.colours.end(), {Rgb{0, 0, 255}, Rgb{255, 0, 0}});
      }
    }
    const Picture picture = picture_of(cloud, {});
    const double front = picture.share(side < 0 ? is_blue : is_red);
    const double back = picture.share(side < 0 ? is_red : is_blue);
    EXPECT_GT(front, 3.0 * back + 0.1) << side;
  }
}

TEST_F(Preview, DrawsTheColoursOfTheCloudWithoutClasses) {
  Labelled shape = cube();
  shape.cloud.colours.assign(shape.cloud.size(), Rgb{0, 0, 255});
  EXPECT_GT(picture_of(shape.cloud, {}).share(is_blue), 0.2);
  std::fill(shape.classes.begin(), shape.classes.end(), kUnlabelled);
  EXPECT_EQ(picture_of(shape.cloud, shape.classes).share(is_blue), 0.0);
}

TEST_F(Preview, HasTheSameBytesForAnyNumberOfThreadsAndOrderOfPoints) {
  Labelled shape = cube();
  const std::string bytes = bytes_of(shape.cloud, shape.classes);
  set_thread_count(1);
  EXPECT_TRUE(bytes_of(shape.cloud, shape.classes) == bytes);
  set_thread_count(0);
  std::reverse(shape.cloud.positions.begin(), shape.cloud.positions.end());
  std::reverse(shape.classes.begin(), shape.classes.end());
  EXPECT_TRUE(bytes_of(shape.cloud, shape.classes) == bytes);
}

TEST_F(Preview, DoesNotDependOnWhereTheCloudLies) {
  Labelled shape = cube();
  const std::string bytes = bytes_of(shape.cloud, shape.classes);
  // The coordinates are multiples of 1/16: the sums are exact, so the bytes must be the same.
  for (Vec3& p : shape.cloud.positions) p += Vec3(448'321.5, 5'411'932.25, 212.0);
  EXPECT_TRUE(bytes_of(shape.cloud, shape.classes) == bytes);
  for (Vec3& p : shape.cloud.positions) p *= 1024.0;
  EXPECT_TRUE(bytes_of(shape.cloud, shape.classes) == bytes);
}

TEST_F(Preview, SkipsPointsThatAreNotFinite) {
  Labelled shape = cube();
  const std::string bytes = bytes_of(shape.cloud, shape.classes);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Vec3& p : {Vec3(nan, 0, 0), Vec3(0, infinity, 0), Vec3(0, 0, -infinity)}) {
    shape.cloud.positions.push_back(p);
    shape.classes.push_back(kSharpEdge);
  }
  EXPECT_TRUE(bytes_of(shape.cloud, shape.classes) == bytes);
}

TEST_F(Preview, LeavesOutFarOutliers) {
  Labelled shape = cube();
  const std::string bytes = bytes_of(shape.cloud, shape.classes);
  for (const double far : {1e3, -1e9, 1e300}) {
    shape.cloud.positions.emplace_back(far, 0.3 * far, 0.0);
    shape.classes.push_back(kSharpEdge);
  }
  EXPECT_TRUE(bytes_of(shape.cloud, shape.classes) == bytes);
}

TEST_F(Preview, LeavesOutAPlaceThatStandsForNoData) {
  Labelled shape = cube();
  const std::string bytes = bytes_of(shape.cloud, shape.classes);
  const std::size_t many = shape.cloud.size() / 5;
  shape.cloud.positions.insert(shape.cloud.positions.end(), many, Vec3(-5e5, -5e6, -100.0));
  shape.classes.insert(shape.classes.end(), many, kSharpEdge);
  EXPECT_TRUE(bytes_of(shape.cloud, shape.classes) == bytes);
}

TEST_F(Preview, LeavesOutStraysButNotThinlySampledParts) {
  Labelled shape = cube();
  std::fill(shape.classes.begin(), shape.classes.end(), kNonEdge);
  const auto add = [&](int count, double height) {
    for (int i = 0; i < count; ++i) {
      shape.cloud.positions.emplace_back(i % 8 / 4.0 - 0.875, i / 8 % 8 / 4.0 - 0.875,
                                         height + i / 64 / 4.0);
      shape.classes.push_back(kSharpEdge);
    }
  };
  add(256, 1.5);  // four times the distances of the cube
  EXPECT_EQ(picture_of(shape.cloud, shape.classes).share(is_red), 0.0);
  add(2000, 2.5);  // now a quarter of all
  EXPECT_GT(picture_of(shape.cloud, shape.classes).share(is_red), 0.05);
}

TEST_F(Preview, DrawsCloudsThatHaveNoSurface) {
  PointCloud cloud;
  cloud.positions.assign(1, Vec3(3, 4, 5));
  EXPECT_GT(picture_of(cloud, {kSharpEdge}).share(is_red), 0.0);
  cloud.positions.assign(100, Vec3(3, 4, 5));
  EXPECT_GT(picture_of(cloud, std::vector<std::uint8_t>(100, kSharpEdge)).share(is_red), 0.0);
  cloud.positions.clear();
  for (int i = 0; i < 50; ++i) cloud.positions.emplace_back(i, 2 * i, 3 * i);
  EXPECT_GT(picture_of(cloud, std::vector<std::uint8_t>(50, kSharpEdge)).share(is_red), 0.0);
  cloud.normals.assign(50, Vec3::Zero());
  EXPECT_GT(picture_of(cloud, std::vector<std::uint8_t>(50, kSharpEdge)).share(is_red), 0.0);
}

/// The twelve edges of the cube.
std::vector<lines::Curve> edges_of_the_cube(EdgeClass edge_class) {
  std::vector<lines::Curve> edges;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double a : {-1.0, 1.0}) {
      for (const double b : {-1.0, 1.0}) {
        Vec3 from = Vec3::Constant(-1.0);
        from[(axis + 1) % 3] = a;
        from[(axis + 2) % 3] = b;
        Vec3 to = from;
        to[axis] = 1.0;
        edges.push_back(
            {.kind = lines::CurveKind::kSegment, .edge_class = edge_class, .points = {from, to}});
      }
    }
  }
  return edges;
}

TEST_F(Preview, DrawsCurvesInTheColoursOfTheirClasses) {
  const Labelled shape = cube();
  const PreviewOptions options{.width = 320, .height = 240};
  const auto is_of_a_boundary = [](const Rgb& c) { return c[2] > c[0] + 100; };
  const auto is_of_a_corner = [](const Rgb& c) { return c == Rgb{32, 36, 42}; };
  const auto drawn = [&](const std::vector<lines::Curve>& curves) {
    return picture_of(shape.cloud, {}, options, curves);
  };
  EXPECT_EQ(drawn({}).share(is_red), 0.0);
  const Picture sharp = drawn(edges_of_the_cube(kSharpEdge));
  EXPECT_GT(sharp.share(is_red), 0.01);
  EXPECT_GT(sharp.share(is_of_a_corner), 7 * 2.0 / (320 * 240));
  EXPECT_GT(drawn(edges_of_the_cube(kSmoothEdge)).share(is_yellow), 0.01);
  EXPECT_GT(drawn(edges_of_the_cube(kBoundary)).share(is_of_a_boundary), 0.01);
}

TEST_F(Preview, DrawsCurvesWhereThePointsAreAndHidesThoseBehindThem) {
  const Labelled shape = cube();
  const PreviewOptions options{.width = 640, .height = 480, .view_direction = Vec3(0, 1, 0)};
  // Pixels covered, those at the rim of a line in part.
  const auto ink = [&](const lines::Curve& curve) {
    double sum = 0.0;
    for (const Rgb& c : picture_of(shape.cloud, {}, options, {curve}).pixels) {
      sum += (c[0] - c[1]) / 168.0;
    }
    return sum;
  };
  const lines::Curve circle{.kind = lines::CurveKind::kCircle,
                            .points = {Vec3(0.5, -1, 0)},
                            .closed = true,
                            .centre = Vec3(0, -1, 0),
                            .axis = Vec3(0, -1, 0),
                            .radius = 0.5};
  const lines::Curve segment{.points = {Vec3(-0.9, -1, 0.5), Vec3(0.9, -1, 0.5)}};
  const double in_front = ink(segment);
  EXPECT_GT(in_front, 0.9 * 0.88 * 480);  // the front of the cube spans 88 % of the height
  EXPECT_NEAR(ink(circle) / in_front, length_of(circle) / length_of(segment), 0.1);
  lines::Curve behind = segment;
  for (Vec3& p : behind.points) p.y() = 1.0;
  EXPECT_EQ(ink(behind), 0.0);
  for (Vec3& p : behind.points) p.y() = 0.0;
  EXPECT_EQ(ink(behind), 0.0);
}

TEST_F(Preview, DrawsALineThatRunsIntoTheDepthAsIfItWereManyShortOnes) {
  PointCloud sheet;
  for (int i = 0; i < 20000; ++i) sheet.positions.emplace_back(i / 100 * 0.01, i % 100 * 0.01, 0.0);
  const PreviewOptions options{
      .width = 640, .height = 480, .view_direction = direction_from(20.0, 12.0)};
  const auto red = [&](int parts) {
    std::vector<lines::Curve> curves;
    for (int i = 0; i < parts; ++i) {
      const auto at = [&](int part) { return Vec3(2.0 * part / parts, 0.5, 0.0); };
      curves.push_back({.kind = lines::CurveKind::kSegment,
                        .edge_class = kSharpEdge,
                        .points = {at(i), at(i + 1)}});
    }
    const auto is_reddish = [](const Rgb& c) { return c[0] > c[1] + 60; };
    return picture_of(sheet, {}, options, curves).share(is_reddish);
  };
  EXPECT_GT(red(1), 0.8 * red(20));
}

TEST_F(Preview, DrawsCurvesWithTheSameBytesForAnyThreadsAndPlace) {
  Labelled shape = cube();
  std::vector<lines::Curve> curves = edges_of_the_cube(kSharpEdge);
  const PreviewOptions options{.width = 160, .height = 120};
  const std::string bytes = bytes_of(shape.cloud, {}, options, curves);
  set_thread_count(1);
  EXPECT_TRUE(bytes_of(shape.cloud, {}, options, curves) == bytes);
  set_thread_count(0);
  const Vec3 far(448'321.5, 5'411'932.25, 212.0);
  for (Vec3& p : shape.cloud.positions) p += far;
  for (lines::Curve& curve : curves) {
    for (Vec3& p : curve.points) p += far;
  }
  EXPECT_TRUE(bytes_of(shape.cloud, {}, options, curves) == bytes);
}

void expect_refused(ErrorKind kind, const std::filesystem::path& png, const PointCloud& cloud,
                    const std::vector<std::uint8_t>& classes,
                    const PreviewOptions& options = {.width = 16, .height = 16}) {
  const auto error = test::error_of([&] { write_preview(png, cloud, classes, options); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), kind);
  EXPECT_NE(std::string(error->what()).find(png.string()), std::string::npos) << error->what();
}

TEST_F(Preview, RefusesACloudWithoutFinitePoints) {
  PointCloud cloud;
  expect_refused(ErrorKind::kInsufficient, path(), cloud, {});
  cloud.positions.assign(3, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  expect_refused(ErrorKind::kInsufficient, path(), cloud, {});
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(Preview, RefusesRequestsThatMakeNoSense) {
  const Labelled shape = cube();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const PreviewOptions& options : {PreviewOptions{.width = 0}, PreviewOptions{.height = 8193},
                                        PreviewOptions{.view_direction = Vec3::Zero()},
                                        PreviewOptions{.view_direction = Vec3(nan, 0, 1)}}) {
    expect_refused(ErrorKind::kUsage, path(), shape.cloud, {}, options);
  }
  expect_refused(ErrorKind::kFailure, path(), shape.cloud, {kNonEdge});
  expect_refused(ErrorKind::kFailure, folder_ / "missing" / "a.png", shape.cloud, {});
}

TEST_F(Preview, LeavesAnExistingFileAlone) {
  std::ofstream(path()) << "mine";
  const Labelled shape = cube();
  expect_refused(ErrorKind::kUsage, path(), shape.cloud, {});
  std::string content;
  std::ifstream(path()) >> content;
  EXPECT_EQ(content, "mine");
  EXPECT_GT(bytes_of(shape.cloud, {}).size(), 100u);
}

}  // namespace
}  // namespace pcednet::render
