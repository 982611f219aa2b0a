#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

#include "pcednet/core/parallel.h"
#include "pcednet/io/las/file.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/las/layout.h"
#include "pcednet/io/las/laz.h"
#include "pcednet/io/las/records.h"
#include "pcednet/io/scanners.h"

namespace pcednet::io {
namespace {

/// The points of a LAS or LAZ file, any range of them.
class LasSource {
 public:
  LasSource(const InputFile& file, std::vector<std::string>& warnings)
      : file_(file), las_(read_las_file(file, warnings)) {
    if (las_.compressed()) {
      compressed_.emplace(file, las_, warnings);
      forget_compression(las_);
    } else {
      check_las_points(file, las_, warnings);
    }
    comments_ = take_las_comments(las_);
    const CoordinateSystem system = coordinate_system_of(las_);
    if (system.geographic) {
      warnings.emplace_back(
          "coordinates are in degrees: lengths across and up differ; project the cloud first");
    } else if (system.stretched) {
      warnings.emplace_back(
          "heights have another unit than x and y, by its coordinate system: angles and lengths "
          "are wrong; bring them to one unit first");
    }
    LasRecordSink(las_, 0, warnings);  // warns of faulty extra bytes
  }

  const LasFile& las() const { return las_; }
  const std::vector<std::string>& comments() const { return comments_; }

  /// Where to cut for parts of about `most` points: the end of each.
  std::vector<std::size_t> cuts(std::size_t most) const {
    const std::size_t count = las_.point_count();
    std::vector<std::size_t> ends;
    if (!compressed_) {
      for (std::size_t end = 0; end < count;) ends.push_back(end = std::min(end + most, count));
      return ends;
    }
    const std::size_t chunks = compressed_->chunk_count();
    const auto end_of = [&](std::size_t chunk) {
      return chunk + 1 < chunks ? compressed_->chunk_begin(chunk + 1) : count;
    };
    std::size_t begin = 0;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      const bool cut = chunk + 1 == chunks || end_of(chunk + 1) - begin > most;
      if (cut) ends.push_back(begin = end_of(chunk));
    }
    return ends;
  }

  /// The points [begin, end), which cuts() named. Colours are left to the caller.
  PointCloud read(std::size_t begin, std::size_t end) const {
    std::vector<std::string> said;
    LasRecordSink sink(las_, compressed_ ? 0 : end - begin, said);
    compressed_ ? read_compressed(begin, end, sink) : read_plain(begin, end, sink);
    return sink.finish();
  }

 private:
  void read_plain(std::size_t first, std::size_t last, LasRecordSink& sink) const {
    const std::size_t stride = las_.record_length();
    parallel_blocks(last - first, 16384, [&](std::size_t begin, std::size_t end) {
      std::vector<std::byte> rows((end - begin) * stride);
      file_.read(las_.points_offset() + (first + begin) * stride, rows);
      sink.take(rows.data(), begin, end);
    });
  }

  /// Room for points that so few bytes can hardly encode is made only once those before are
  /// decoded.
  void read_compressed(std::size_t first, std::size_t last, LasRecordSink& sink) const {
    std::vector<std::size_t> chunks;
    for (std::size_t c = 0; c < compressed_->chunk_count(); ++c) {
      const std::size_t begin = compressed_->chunk_begin(c);
      if (begin >= first && begin < last) chunks.push_back(c);
    }
    const bool usual = last - first <= kUsualPointsPerByte * file_.size();
    const std::size_t at_once = usual ? std::max<std::size_t>(chunks.size(), 1) : kChunksAtOnce;
    for (std::size_t start = 0; start < chunks.size(); start += at_once) {
      const std::size_t end = std::min(start + at_once, chunks.size());
      sink.grow((end < chunks.size() ? compressed_->chunk_begin(chunks[end]) : last) - first);
      parallel_blocks(end - start, 1, [&](std::size_t c, std::size_t) {
        const std::size_t chunk = chunks[start + c];
        const std::vector<std::byte> rows = compressed_->decode(chunk);
        const std::size_t begin = compressed_->chunk_begin(chunk) - first;
        sink.take(rows.data(), begin, begin + rows.size() / las_.record_length());
      });
    }
  }

  static constexpr std::uint64_t kUsualPointsPerByte = 4;
  static constexpr std::size_t kChunksAtOnce = 16;

  const InputFile& file_;
  LasFile las_;
  std::optional<LazReader> compressed_ = {};
  std::vector<std::string> comments_ = {};
};

/// Adds the file's data beside its points.
void describe(const LasSource& source, PointCloud& cloud) {
  attach_las_file(cloud, source.las());
  cloud.comments = source.comments();
  cloud.scanners = scanners_of_comments(cloud.comments);
}

class LasPartReader : public PartReader {
 public:
  LasPartReader(std::unique_ptr<InputFile> file, std::size_t most)
      : file_(std::move(file)), source_(*file_, warnings), ends_(source_.cuts(most)) {}

  std::size_t points() const override { return ends_.empty() ? 0 : ends_.back(); }
  std::size_t parts() const override { return ends_.size(); }
  bool is_las() const override { return true; }

  bool narrow_colours() const override {
    std::call_once(looked_, [&] {
      for (std::size_t part = 0; part < parts() && narrow_; ++part) {
        const PointCloud points = records(part);
        if (las_colours(points, true).empty()) break;
        narrow_ = has_narrow_colours(points);
      }
    });
    return narrow_;
  }
  void set_narrow_colours(bool narrow) override {
    std::call_once(looked_, [&] { narrow_ = narrow; });
  }

  PointCloud read(std::size_t part) const override {
    PointCloud cloud = records(part);
    cloud.colours = las_colours(cloud, narrow_colours());
    if (part == 0) describe(source_, cloud);
    return cloud;
  }

 private:
  PointCloud records(std::size_t part) const {
    return source_.read(part == 0 ? 0 : ends_[part - 1], ends_[part]);
  }

  std::unique_ptr<InputFile> file_;
  LasSource source_;
  std::vector<std::size_t> ends_;
  mutable std::once_flag looked_ = {};
  mutable bool narrow_ = true;  ///< all colours are below 256
};

}  // namespace

LoadedCloud read_las(const InputFile& file) {
  LoadedCloud loaded;
  const LasSource source(file, loaded.warnings);
  loaded.cloud = source.read(0, source.las().point_count());
  loaded.cloud.colours = las_colours(loaded.cloud, has_narrow_colours(loaded.cloud));
  describe(source, loaded.cloud);
  return loaded;
}

std::unique_ptr<PartReader> open_las_parts(std::unique_ptr<InputFile> file, std::size_t most) {
  return std::make_unique<LasPartReader>(std::move(file), most);
}

}  // namespace pcednet::io
