#include "pcednet/tiles/sort_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <numeric>

#include "pcednet/core/blocks.h"
#include "pcednet/formats/parts.h"
#include "pcednet/io/parts.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/tiles/forms.h"
#include "pcednet/tiles/inputs.h"

namespace pcednet::tiles {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kOpenFiles = 256;
constexpr const char* kUnsorted = "unsorted_";

/// The files of the copies: LAS and PLY, which are read from any place.
fs::path copy_path(const fs::path& folder, const Plan& plan, std::size_t tile, const char* prefix) {
  const std::size_t digits = std::to_string(plan.tiles.size() - 1).size();
  return folder /
         fmt::format("{}{:0{}}{}", prefix, tile, digits, plan.las_steps.empty() ? ".ply" : ".las");
}

/// The copies of the tiles: unsorted ones go with it, and unless keep() is called the sorted too.
class Copies {
 public:
  Copies(const fs::path& folder, const Plan& plan) : folder_(folder), plan_(plan) {}
  Copies(const Copies&) = delete;
  Copies& operator=(const Copies&) = delete;
  ~Copies() {
    std::error_code ignored;
    for (std::size_t id = 0; id < plan_.tiles.size(); ++id) fs::remove(unsorted(id), ignored);
    for (std::size_t id = 0; id < made_; ++id) fs::remove(sorted(id), ignored);
  }

  fs::path unsorted(std::size_t tile) const { return copy_path(folder_, plan_, tile, kUnsorted); }
  fs::path sorted(std::size_t tile) const { return copy_path(folder_, plan_, tile, ""); }
  void count_sorted() { ++made_; }  ///< they are made in the order of the tiles
  void keep() { made_ = 0; }

 private:
  const fs::path& folder_;
  const Plan& plan_;
  std::size_t made_ = 0;
};

/// Throws if a copy would replace an input or what must stay.
void check_copies(const SortRequest& request, const Plan& plan) {
  for (std::size_t id = 0; id < plan.tiles.size(); ++id) {
    for (const char* prefix : {kUnsorted, ""}) {
      const fs::path path = copy_path(request.folder, plan, id, prefix);
      check_not_input(path, plan.inputs);
      check_writable(path, request.overwrite);
    }
  }
}

/// A file that points are appended to; it is created with the first of them.
class Copy {
 public:
  Copy(fs::path path, const Plan& plan, std::size_t points)
      : path_(std::move(path)), is_las_(!plan.las_steps.empty()), points_(points) {}

  void append(const PointCloud& some) {
    if (!writer_) {
      first_ = some;
      writer_ = formats::create_parts(path_,
                                      {.points = points_,
                                       .first = &first_,
                                       .each_part = [this](const auto& visit) { visit(first_); },
                                       .is_las = is_las_},
                                      {.overwrite = Overwrite::kYes});
    }
    writer_->append(some);
  }
  void commit() { writer_->commit(); }

 private:
  fs::path path_;
  bool is_las_;
  std::size_t points_;
  PointCloud first_ = {};
  std::unique_ptr<io::PartWriter> writer_ = {};
};

/// The tile of every point of a part.
class TileFinder {
 public:
  explicit TileFinder(const Plan& plan) : grid_(plan.grid) {
    for (std::size_t id = 0; id < plan.tiles.size(); ++id) {
      tiles_[{plan.tiles[id].column, plan.tiles[id].row}] = id;
    }
  }
  std::size_t operator()(const Vec3& position) const {
    return has_place(position) ? tiles_.at(grid_.core_of(position)) : 0;
  }

 private:
  Grid grid_;
  std::map<std::array<std::int64_t, 2>, std::size_t> tiles_ = {};
};

/// The numbers from `first` on as a column; double, as PLY has no 64-bit integers.
Attribute number_column(std::size_t first, std::size_t points) {
  std::vector<double> numbers(points);
  std::iota(numbers.begin(), numbers.end(), static_cast<double>(first));
  return make_attribute(kNumberColumn, numbers);
}

/// Writes the points of the tiles [begin, end) to a file each, in the order of the inputs.
void scatter(const fs::path& folder, const Plan& plan, const PointCloud& outline, std::size_t begin,
             std::size_t end, const Progress* progress) {
  std::deque<Copy> copies;  // stay where they are
  for (std::size_t id = begin; id < end; ++id) {
    copies.emplace_back(copy_path(folder, plan, id, kUnsorted), plan, plan.tiles[id].points);
  }
  const TileFinder tile_of(plan);
  const bool numbered = find_attribute(outline, kNumberColumn) != nullptr;
  std::size_t before = 0;
  Stage stage(progress, "sort", plan.points());
  for (const PlannedInput& input : plan.inputs) {
    const auto use = [&](PointCloud& part, std::size_t first) {
      if (numbered) part.attributes.push_back(number_column(before + first, part.size()));
      take_columns(outline, part);
      std::vector<std::vector<std::uint32_t>> chosen(copies.size());
      for (std::uint32_t i = 0; i < part.size(); ++i) {
        const std::size_t id = tile_of(part.positions[i]);
        if (id >= begin && id < end) chosen[id - begin].push_back(i);
      }
      for (std::size_t k = 0; k < copies.size(); ++k) {
        if (chosen[k].empty()) continue;
        PointCloud some = outline;
        append_points(part, chosen[k], some);
        copies[k].append(some);
      }
      stage.advance(part.size());
    };
    for_each_chunk(
        input, [](const Chunk&) { return true; }, progress, use);
    before += input.points();
  }
  for (Copy& copy : copies) copy.commit();
}

/// Writes the points of a scattered file along the curve, those without a place last.
void sort_file(const fs::path& from, const fs::path& to, const Plan& plan,
               const PointCloud& outline) {
  const auto reader = open_chunks(from);
  reader->set_narrow_colours(plan.narrow_colours());
  PointCloud all = outline;
  for (std::size_t p = 0; p < reader->parts(); ++p) {
    const PointCloud part = read_finished(*reader, p);
    std::vector<std::uint32_t> every(part.size());
    std::iota(every.begin(), every.end(), 0u);
    append_points(part, every, all);
  }
  std::vector<std::uint32_t> order = spatial::curve_order(places_of(all.positions));
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (!has_place(all.positions[i])) order.push_back(i);
  }
  Copy copy(to, plan, all.size());
  for_each_block(order.size(), kChunkPoints, [&](std::size_t begin, std::size_t end) {
    PointCloud some = outline;
    append_points(all, std::span(order).subspan(begin, end - begin), some);
    copy.append(some);
  });
  copy.commit();
  std::error_code ignored;  // at the end it is tried again
  fs::remove(from, ignored);
}

}  // namespace

void sort_inputs(const SortRequest& request, Plan& plan, const Progress* progress) {
  const fs::path& folder = request.folder;
  make_folder(folder);
  check_copies(request, plan);
  PointCloud outline = outline_of(plan);
  if (request.numbered) outline.attributes.push_back(number_column(0, 0));
  Copies copies(folder, plan);
  for_each_block(plan.tiles.size(), kOpenFiles, [&](std::size_t begin, std::size_t end) {
    scatter(folder, plan, outline, begin, end, progress);
  });
  std::vector<PlannedInput> sorted;
  for (std::size_t id = 0; id < plan.tiles.size(); ++id) {
    throw_if_cancelled(progress);
    const fs::path path = copies.sorted(id);
    sort_file(copies.unsorted(id), path, plan, outline);
    copies.count_sorted();
    std::vector<std::string> known;
    const auto see = [](const PointCloud&) {};
    sorted.push_back(index_input(path, progress, known, see, plan.narrow_colours()).input);
  }
  copies.keep();
  plan.inputs = std::move(sorted);
  plan.forms = {0}, plan.timed = 0;
}

}  // namespace pcednet::tiles
