#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "pcednet/io/cloud_builder.h"
#include "pcednet/io/file_lines.h"
#include "pcednet/io/scanners.h"
#include "pcednet/io/text/number_table.h"
#include "pcednet/io/text/ptx.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// The header of a scan.
struct PtxScan {
  std::uint64_t columns = 0, rows = 0;
  Vec3 scanner = Vec3::Zero();  ///< in the world
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 shift = Vec3::Zero();  ///< world = turn * point + shift
  bool has_points = false, has_colours = false;

  bool moves() const { return !turn.isIdentity(0.0) || !shift.isZero(0.0); }
  bool is_grid() const { return columns > 1 && rows > 1; }

  /// Where the scanner stood; NaN if unknown.
  Vec3 origin() const {
    if (moves()) return shift;
    return is_grid() || !scanner.isZero(0.0) ? scanner : Vec3::Constant(NAN);
  }
};

/// The most numbers in the line of a point; those of some scans hold fewer.
constexpr std::size_t kWidth = 7;  // x y z intensity red green blue
constexpr std::size_t kIntensity = 3, kColour = 4;

class PtxReader {
 public:
  explicit PtxReader(const InputFile& file)
      : path_(file.path()), bytes_(file.size()), lines_(file) {}

  LoadedCloud read() {
    std::vector<PtxScan> scans;
    std::string_view line;
    while (lines_.next_filled(line)) {
      scans.push_back(read_header(line));
      read_points(scans.back(), scans.size() - 1);
    }
    if (scans.empty()) throw error("expected the number of columns of a scan");
    LoadedCloud loaded = build(scans);
    for (const PtxScan& scan : scans) add_scanner(scan.origin(), loaded.cloud);
    return loaded;
  }

 private:
  Error error(const std::string& what) const { return unreadable(path_, what, lines_.number()); }

  /// The numbers of the next line of a header.
  template <std::size_t kCount>
  std::array<double, kCount> header_line(const char* what) {
    std::string_view line;
    if (!lines_.next_filled(line)) throw error(fmt::format("ends before {}", what));
    split(line, words_);
    std::array<double, kCount> numbers;
    bool are_numbers = words_.size() == kCount;
    for (std::size_t i = 0; are_numbers && i < kCount; ++i) {
      const auto number = parse_double(words_[i]);
      are_numbers = number && std::isfinite(*number);
      numbers[i] = number.value_or(0.0);
    }
    if (!are_numbers) throw error(fmt::format("expected {}: {} numbers", what, kCount));
    return numbers;
  }

  std::uint64_t count(std::string_view line, const char* what) const {
    const auto number = parse_count(trim(line));
    if (!number) throw error(fmt::format("expected the number of {} of a scan", what));
    return *number;
  }

  PtxScan read_header(std::string_view first) {
    PtxScan scan;
    scan.columns = count(first, "columns");
    std::string_view line;
    if (!lines_.next_filled(line)) throw error("ends before the number of rows");
    scan.rows = count(line, "rows");
    if (scan.rows > 0 && scan.columns > bytes_ / scan.rows) {  // each cell is a line
      throw error(fmt::format("declares {} columns of {} rows, more than the file holds",
                              scan.columns, scan.rows));
    }
    scan.scanner = Vec3(header_line<3>("the position of the scanner").data());
    for (int axis = 0; axis < 3; ++axis) header_line<3>("an axis of the scanner");
    for (int row = 0; row < 3; ++row) {
      scan.turn.col(row) = Vec3(header_line<4>("a row of the matrix").data());
    }
    scan.shift = Vec3(header_line<4>("the last row of the matrix").data());
    if (scan.turn.determinant() == 0.0) throw error("the matrix is singular");
    return scan;
  }

  void read_points(PtxScan& scan, std::size_t number) {
    const std::uint64_t cells = scan.columns * scan.rows;
    std::string_view line;
    for (std::uint64_t cell = 0; cell < cells; ++cell) {
      if (!lines_.next_filled(line)) {
        throw error(fmt::format("scan {} declares {} columns of {} rows, but ends after {} points",
                                number, scan.columns, scan.rows, cell));
      }
      take_point(line, scan);
      scan_of_point_.resize(table_.rows(), static_cast<std::int32_t>(number));
    }
  }

  void take_point(std::string_view line, PtxScan& scan) {
    split(line, words_);
    const std::size_t size = words_.size();
    const bool has_intensity = size == 4 || size == 7, has_colour = size == 6 || size == 7;
    if (size != 3 && !has_intensity && !has_colour) {
      throw error(
          fmt::format("{} numbers: expected x y z, then an intensity, a colour, or both", size));
    }
    std::array<double, kWidth> row = {};
    row[kIntensity] = NAN;
    for (std::size_t i = 0; i < size; ++i) {
      const auto value = parse_double(words_[i]);
      if (!value) throw error(number_fault(words_[i]));
      row[i < 3 || has_intensity ? i : i + 1] = *value;
    }
    if (row[0] == 0.0 && row[1] == 0.0 && row[2] == 0.0) {
      ++empty_;
      return;
    }
    const Vec3 place = scan.turn * Vec3(row.data()) + scan.shift;
    std::copy_n(place.data(), 3, row.begin());
    has_intensities_ = has_intensities_ || has_intensity;
    scan.has_points = true, scan.has_colours = scan.has_colours || has_colour;
    std::copy(row.begin(), row.end(), table_.add_row());
  }

  LoadedCloud build(const std::vector<PtxScan>& scans) {
    const auto with_colours = std::count_if(scans.begin(), scans.end(),
                                            [](const PtxScan& scan) { return scan.has_colours; });
    const auto with_points = std::count_if(scans.begin(), scans.end(),
                                           [](const PtxScan& scan) { return scan.has_points; });
    std::vector<Column> columns = {{"x"},   {"y"},     {"z"},   {"intensity"},
                                   {"red"}, {"green"}, {"blue"}};
    columns[kIntensity].skip = !has_intensities_;
    for (std::size_t c = kColour; c < kWidth; ++c) columns[c].skip = with_colours == 0;
    CloudBuilder builder(path_, columns, scan_of_point_.size());
    table_.move_to(builder);
    LoadedCloud loaded = builder.finish();
    if (scans.size() > 1) set_attribute(loaded.cloud, make_attribute("scan", scan_of_point_));
    if (empty_ > 0) {
      loaded.warnings.push_back(fmt::format(
          "{} at 0 0 0 hold{} no point: left out",
          empty_ == 1 ? "1 cell" : fmt::format("{} cells", empty_), empty_ == 1 ? "s" : ""));
    }
    if (with_colours > 0 && with_colours < with_points) {
      loaded.warnings.push_back(
          fmt::format("{} of {} scans have no colours: their points are black",
                      with_points - with_colours, with_points));
    }
    return loaded;
  }

  const std::filesystem::path& path_;
  std::uint64_t bytes_;
  FileLines lines_;
  std::vector<std::string_view> words_;
  NumberTable table_{kWidth};
  std::vector<std::int32_t> scan_of_point_;
  std::size_t empty_ = 0;  ///< cells
  bool has_intensities_ = false;
};

}  // namespace

LoadedCloud read_ptx(const InputFile& file) {
  return PtxReader(file).read();
}

}  // namespace pcednet::io
