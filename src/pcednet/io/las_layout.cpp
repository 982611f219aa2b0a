#include "pcednet/io/las_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/io/las.h"
#include "pcednet/io/las_comments.h"
#include "pcednet/io/las_records.h"

namespace pcednet::io {
namespace {

constexpr std::size_t kDescriptorBytes = 192;

constexpr int kLeastDigits = 4, kMostDigits = 9;

bool is_exact(const PointCloud& cloud, const LasFile& file) {
  for (const Vec3& p : cloud.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = p[static_cast<int>(axis)];
      const double step = las_step(file, axis, value);
      if (std::isfinite(value) && step * file.scale(axis) + file.offset(axis) != value) {
        return false;
      }
    }
  }
  return true;
}

bool all_exact(const PartOutline& outline, const LasFile& file) {
  bool exact = true;
  outline.each_part([&](const PointCloud& part) { return exact = exact && is_exact(part, file); });
  return exact;
}

bool fits(const BoundingBox& box, const LasFile& file) {
  if (box.empty()) return true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double end : {box.min[static_cast<int>(axis)], box.max[static_cast<int>(axis)]}) {
      if (!std::isfinite(las_step(file, axis, end))) return false;
    }
  }
  return true;
}

BoundingBox box_of(const PartOutline& outline) {
  BoundingBox box;
  outline.each_part([&](const PointCloud& part) {
    const BoundingBox more = bounding_box(part.positions);
    box.min = box.min.cwiseMin(more.min);
    box.max = box.max.cwiseMax(more.max);
    return true;
  });
  return box;
}

LasFile with_digits(LasFile file, int digits) {
  const double scale = digits < 0 ? std::pow(10.0, -digits) : 1.0 / std::pow(10.0, digits);
  for (std::size_t axis = 0; axis < 3; ++axis) put_number(file.header, 131 + 8 * axis, scale);
  return file;
}

/// Offsets at whole numbers, and the coarsest step of at most 0.1 mm that keeps every coordinate as
/// it is; if none does, the finest that 32 bits reach with. Coarser only where they reach no
/// further.
bool choose_scale(const PartOutline& outline, const BoundingBox& box, LasFile& file) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    const double middle = box.empty() ? 0.0 : std::round((box.min[a] + box.max[a]) / 2);
    put_number(file.header, 155 + 8 * axis, middle);
  }
  std::vector<LasFile> candidates;
  for (int digits = kLeastDigits; digits <= kMostDigits; ++digits) {
    LasFile candidate = with_digits({.header = file.header}, digits);
    if (!fits(box, candidate)) break;
    candidates.push_back(std::move(candidate));
  }
  if (candidates.empty()) {
    int digits = kLeastDigits - 1;
    while (digits > -300 && !fits(box, with_digits({.header = file.header}, digits))) --digits;
    file = with_digits(std::move(file), digits);
    return all_exact(outline, file);
  }
  const std::string finest = candidates.back().header;
  outline.each_part([&](const PointCloud& part) {
    std::erase_if(candidates, [&](const LasFile& c) { return !is_exact(part, c); });
    return !candidates.empty();
  });
  file.header = candidates.empty() ? finest : candidates.front().header;
  return !candidates.empty();
}

LasFile new_file(bool with_colours) {
  LasFile file;
  file.header.assign(375, '\0');
  file.header.replace(0, 4, "LASF");
  put_number<std::uint16_t>(file.header, 6, 16);  // the coordinate system, if any, is WKT
  put_number<std::uint8_t>(file.header, 24, 1);
  put_number<std::uint8_t>(file.header, 25, 4);
  file.header.replace(26, 7, "pcednet");
  file.header.replace(58, 7, "pcednet");
  put_number<std::uint8_t>(file.header, 104, with_colours ? 7 : 6);
  return file;
}

/// Whether the colours are more than what Red, Green and Blue, if there are, say.
bool colours_are_new(const PartOutline& outline) {
  if (outline.first->colours.empty()) return false;
  if (las_colours(*outline.first, true).empty()) return true;
  bool narrow = true, same = true;
  outline.each_part(
      [&](const PointCloud& part) { return narrow = narrow && has_narrow_colours(part); });
  outline.each_part([&](const PointCloud& part) {
    return same = same && las_colours(part, narrow) == part.colours;
  });
  return !same;
}

bool labels_are_classes(const PartOutline& outline) {
  bool same = outline.first->has_labels();
  const auto is_class = [](const PointCloud& part) {
    const Attribute* edge_class = find_attribute(part, "scalar_edge_class");
    return edge_class && edge_class->type == ScalarType::kUint8 &&
           edge_class->bytes.size() == part.labels.size() &&
           std::memcmp(edge_class->bytes.data(), part.labels.data(), part.labels.size()) == 0;
  };
  if (!same || !is_class(*outline.first)) return false;
  outline.each_part([&](const PointCloud& part) { return same = same && is_class(part); });
  return same;
}

/// The record that describes the extra bytes; null if there is none.
LasRecord* descriptor_record(LasFile& file) {
  const auto found = std::find_if(file.records.begin(), file.records.end(),
                                  [](const LasRecord& r) { return r.is("LASF_Spec", 4); });
  return found == file.records.end() ? nullptr : &*found;
}

/// Its descriptors, whole ones.
std::string descriptors_of(LasFile& file) {
  const LasRecord* record = descriptor_record(file);
  if (record == nullptr) return {};
  return record->data.substr(0, record->data.size() / kDescriptorBytes * kDescriptorBytes);
}

/// Builds the columns: those of the file's own fields first, then extra bytes for what is left.
class LayoutBuilder {
 public:
  LayoutBuilder(const PointCloud& part, const WriteOptions& options, const LasChoices& choices)
      : cloud_(part), options_(options), choices_(choices), file_(layout_.file) {
    file_ = choices.file;
  }

  LasLayout build() {
    std::vector<std::string> ignored;
    std::vector<LasField> fields = las_standard_fields(file_.point_format());
    fields.erase(fields.begin(), fields.begin() + 3);
    if (has_template_extras()) {
      const auto extra = las_extra_fields(file_, ignored);
      fields.insert(fields.end(), extra.begin(), extra.end());
    } else {
      put_number(file_.header, 105,
                 static_cast<std::uint16_t>(las_format_bytes(file_.point_format())));
    }
    descriptors_ = descriptors_of(file_);
    for (const LasField& field : fields) {
      taken_.insert(field.name);
      add_known(field);
    }
    add_new();
    put_descriptors();
    if (auto comments = las_comment_record(cloud_.comments)) {
      file_.records.push_back(std::move(*comments));
    }
    return std::move(layout_);
  }

 private:
  bool has_template_extras() const {
    return file_.record_length() > las_format_bytes(file_.point_format());
  }

  /// In the place of the file's own record, which stays as it is if nothing was added.
  void put_descriptors() {
    if (descriptors_.size() > UINT16_MAX) too_many();
    if (descriptors_ == descriptors_of(file_)) return;
    if (LasRecord* record = descriptor_record(file_)) {
      record->data = std::move(descriptors_);
    } else {
      file_.records.push_back({"LASF_Spec", 4, "extra bytes", std::move(descriptors_)});
    }
  }

  void add_known(const LasField& field) {
    const auto channel = std::find(std::begin(kChannels), std::end(kChannels), field.name);
    if (channel != std::end(kChannels) && choices_.new_colours) {
      const auto c = static_cast<std::size_t>(channel - std::begin(kChannels));
      if (!cloud_.empty()) {
        layout_.columns.push_back({field, reinterpret_cast<const std::byte*>(&cloud_.colours[0][c]),
                                   sizeof(Rgb), LasColumn::Scale::kColour});
      }
      return;
    }
    if (add_normal(field) || add_label(field)) return;
    const Attribute* attribute = find_attribute(cloud_, field.name);
    if (attribute && attribute->type == field.type && attribute->components == field.components) {
      layout_.columns.push_back({field, attribute->bytes.data(), attribute->stride()});
      used_.insert(field.name);
      return;
    }
    // Formats without returns in their source have one per pulse.
    static constexpr std::byte kOne{1};
    if (field.name == "ReturnNumber" || field.name == "NumberOfReturns") {
      layout_.columns.push_back({field, &kOne, 0});
    }
  }

  bool add_normal(const LasField& field) {
    const auto axis = std::find(std::begin(kAxes), std::end(kAxes), field.name);
    if (axis == std::end(kAxes) || !cloud_.has_normals()) return false;
    const auto* number = cloud_.normals[0].data() + (axis - std::begin(kAxes));
    layout_.columns.push_back({field, reinterpret_cast<const std::byte*>(number), sizeof(Vec3),
                               LasColumn::Scale::kNormal});
    has_normals_ = true;
    return true;
  }

  bool add_label(const LasField& field) {
    if (field.name != "label" || field.type != ScalarType::kUint8 || !cloud_.has_labels()) {
      return false;
    }
    layout_.columns.push_back({field, reinterpret_cast<const std::byte*>(cloud_.labels.data()), 1});
    has_label_ = true;
    return true;
  }

  void add_new() {
    if (cloud_.has_normals() && !has_normals_ && options_.new_normals) {
      for (const char* name : kAxes) add_normal(new_field(name, ScalarType::kFloat32));
    }
    const bool has_result = find_attribute(cloud_, "scalar_p_sharp") != nullptr;
    for (const Attribute& attribute : cloud_.attributes) {
      const bool derived = attribute.name == "quality" && has_result;
      if (used_.count(attribute.name) != 0 || derived || is_channel(attribute.name)) continue;
      const bool wide = attribute.components * size_of(attribute.type) > 255;
      for (std::size_t c = 0; c < (wide || attribute.components > 1 ? attribute.components : 1);
           ++c) {
        const std::string name = attribute.components > 1
                                     ? fmt::format("{}[{}]", attribute.name.substr(0, 26), c)
                                     : attribute.name;
        layout_.columns.push_back({new_field(name, attribute.type),
                                   attribute.bytes.data() + c * size_of(attribute.type),
                                   attribute.stride()});
      }
    }
    if (cloud_.has_labels() && !has_label_ && !choices_.label_is_class) {
      add_label(new_field("label", ScalarType::kUint8));
    }
  }

  bool is_channel(const std::string& name) const {
    return std::find(std::begin(kChannels), std::end(kChannels), name) != std::end(kChannels) &&
           taken_.count(name) != 0;
  }

  LasField new_field(const std::string& name, ScalarType type) {
    LasField field{name, type, file_.record_length()};
    const std::size_t length = file_.record_length() + size_of(type);
    if (length > UINT16_MAX) too_many();
    describe_undocumented();
    put_number(file_.header, 105, static_cast<std::uint16_t>(length));
    descriptors_ += las_extra_descriptor(field);
    return field;
  }

  [[noreturn]] static void too_many() {
    throw Error(ErrorKind::kFailure, "the points have more attributes than LAS can hold");
  }

  /// New extra bytes come after what the file has, which must be described for that.
  void describe_undocumented() {
    for (std::size_t at = descriptors_.size(); at > 0;) {
      at -= kDescriptorBytes;
      const bool no_bytes = descriptors_[at + 2] == 0 && descriptors_[at + 3] == 0;
      if (no_bytes) descriptors_.erase(at, kDescriptorBytes);
    }
    LasFile described = file_;
    described.records = {{"LASF_Spec", 4, "", descriptors_}};
    std::vector<std::string> warnings;
    const auto fields = las_extra_fields(described, warnings);
    const std::size_t count = descriptors_.size() / kDescriptorBytes;
    if (fields.size() <= count) {
      descriptors_.resize(fields.size() * kDescriptorBytes);
      return;
    }
    LasField rest = fields.back();
    for (std::size_t left = rest.components; left > 0;) {
      rest.components = std::min<std::size_t>(left, 255);
      left -= rest.components;
      std::string bytes = las_extra_descriptor(rest);
      put_number<std::uint8_t>(bytes, 2, 0);
      put_number(bytes, 3, static_cast<std::uint8_t>(rest.components));
      descriptors_ += bytes;
    }
  }

  static constexpr const char* kChannels[] = {"Red", "Green", "Blue"};
  static constexpr const char* kAxes[] = {"NormalX", "NormalY", "NormalZ"};

  const PointCloud& cloud_;
  const WriteOptions& options_;
  const LasChoices& choices_;
  LasLayout layout_;
  LasFile& file_;
  std::string descriptors_;
  std::set<std::string> taken_, used_;
  bool has_normals_ = false, has_label_ = false;
};

}  // namespace

double las_step(const LasFile& file, std::size_t axis, double coordinate) {
  const double step = std::round((coordinate - file.offset(axis)) / file.scale(axis));
  return step >= INT32_MIN && step <= INT32_MAX ? step : NAN;
}

void write_scaled(const LasColumn& column, const std::byte* from, char* to) {
  if (column.scale == LasColumn::Scale::kColour) {
    const auto wide = static_cast<std::uint16_t>(std::to_integer<unsigned>(*from) * 257U);
    std::memcpy(to, &wide, sizeof wide);
    return;
  }
  double number = 0.0;
  std::memcpy(&number, from, sizeof number);
  if (column.field.type == ScalarType::kFloat64) {
    std::memcpy(to, &number, sizeof number);
    return;
  }
  const auto narrow = static_cast<float>(number);
  std::memcpy(to, &narrow, sizeof narrow);
}

LasChoices las_choices(const PartOutline& outline) {
  LasChoices choices{.file = attached_las_file(*outline.first),
                     .new_colours = !outline.is_las && colours_are_new(outline),
                     .label_is_class = labels_are_classes(outline)};
  const bool is_new = choices.file.header.empty();
  if (!is_new && outline.is_las) return choices;
  if (is_new) choices.file = new_file(!outline.first->colours.empty());
  const BoundingBox box = box_of(outline);
  if (is_new || !fits(box, choices.file)) {
    choices.exact = choose_scale(outline, box, choices.file);
  } else {
    choices.exact = all_exact(outline, choices.file);
  }
  return choices;
}

LasLayout las_layout(const PointCloud& part, const WriteOptions& options,
                     const LasChoices& choices) {
  return LayoutBuilder(part, options, choices).build();
}

std::vector<std::string> las_losses(const PointCloud& first, const LasChoices& choices) {
  const LasFile& file = choices.file;
  std::vector<std::string> losses;
  if (!first.comments.empty() && !las_comment_record(first.comments)) {
    losses.emplace_back("comments of more than 64 KiB");
  }
  if (!choices.exact) {
    losses.push_back(fmt::format("digits of positions beyond steps of {}", file.scale(0)));
  }
  const auto standard = las_standard_fields(file.point_format());
  const bool has_colours = std::any_of(standard.begin(), standard.end(),
                                       [](const LasField& f) { return f.name == "Red"; });
  if (!first.colours.empty() && !has_colours) {
    losses.push_back(
        fmt::format("colours: the input's point format {} has none", file.point_format()));
  }
  return losses;
}

}  // namespace pcednet::io
