#include "pcednet/io/cloud_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include "pcednet/core/bytes.h"
#include "pcednet/core/error.h"
#include "pcednet/io/column_names.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/strided.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

bool is_int64(ScalarType type) {
  return type == ScalarType::kInt64 || type == ScalarType::kUint64;
}

template <typename T>
bool survives(double value) {
  if constexpr (std::numeric_limits<T>::is_integer) {
    if (!is_in_range<T>(value)) return false;
    if (value == 0.0 && std::signbit(value)) return false;
  }
  return std::isnan(value) || static_cast<double>(static_cast<T>(value)) == value;
}

ScalarType position_type(const PointCloud& cloud, const ColumnNames& names) {
  if (is_int64(cloud.position_type) && !names.has_int64) return ScalarType::kFloat64;
  const bool all_survive = visit_scalar(cloud.position_type, [&](auto zero) {
    using T = decltype(zero);
    return std::all_of(cloud.positions.begin(), cloud.positions.end(), [](const Vec3& p) {
      return survives<T>(p.x()) && survives<T>(p.y()) && survives<T>(p.z());
    });
  });
  return all_survive ? cloud.position_type : ScalarType::kFloat64;
}

/// `quality` first, then scalar_*, then the rest, each in the cloud's order.
std::vector<const Attribute*> in_writing_order(const PointCloud& cloud) {
  std::vector<const Attribute*> ordered;
  const auto rank = [](const Attribute* a) {
    if (a->name == "quality") return 0;
    return a->name.starts_with("scalar_") ? 1 : 2;
  };
  for (const Attribute& attribute : cloud.attributes) ordered.push_back(&attribute);
  std::stable_sort(ordered.begin(), ordered.end(),
                   [&](const auto* a, const auto* b) { return rank(a) < rank(b); });
  return ordered;
}

const std::byte* bytes_of(const void* pointer) {
  return static_cast<const std::byte*>(pointer);
}

void add_vectors(std::vector<ColumnView>& columns, const std::vector<Vec3>& vectors,
                 const std::vector<std::string>& names, ScalarType type) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    columns.push_back({names[axis], type, bytes_of(vectors[0].data() + axis), sizeof(Vec3)});
  }
}

void add_normals(std::vector<ColumnView>& columns, const PointCloud& cloud,
                 const std::vector<std::string>& names) {
  const auto is_float = [](const Attribute& axis) { return is_floating(axis.type); };
  const auto& stored = cloud.stored_normals;
  if (!cloud.has_normals()) return;
  if (!std::all_of(stored.begin(), stored.end(), is_float) || !normals_are_stored(cloud)) {
    return add_vectors(columns, cloud.normals, names, ScalarType::kFloat32);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    columns.push_back({names[axis], stored[axis].type, stored[axis].bytes.data(),
                       stored[axis].stride(), stored[axis].type});
  }
}

/// Whether a reader would make colours or labels of the attribute.
bool is_mistakable(const Attribute& attribute) {
  const auto has_it = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), lower_case(attribute.name)) != names.end();
  };
  const bool is_named_so =
      has_it(label_names()) || std::any_of(colour_names().begin(), colour_names().end(), has_it);
  return attribute.type == ScalarType::kUint8 && attribute.components == 1 && is_named_so;
}

void add_attribute(std::vector<ColumnView>& columns, const Attribute& attribute,
                   const ColumnNames& names) {
  const bool halve = is_int64(attribute.type) && !names.has_int64;
  for (std::size_t c = 0; c < attribute.components; ++c) {
    const bool numbered = attribute.components > 1 && !names.has_counts;
    const std::string name = numbered ? fmt::format("{}_{}", attribute.name, c) : attribute.name;
    const std::byte* first = attribute.bytes.data() + c * size_of(attribute.type);
    const auto add = [&](std::string_view ending, ScalarType type, const std::byte* numbers) {
      std::string column = column_name(name).append(ending);
      if (is_mistakable(attribute)) column = hidden(std::move(column));
      columns.push_back({std::move(column), type, numbers, attribute.stride(), type, c});
    };
    if (!halve) {
      add("", attribute.type, first);
      continue;
    }
    const bool is_signed = attribute.type == ScalarType::kInt64;
    add(kLowHalf, ScalarType::kUint32, first);  // little-endian
    add(kHighHalf, is_signed ? ScalarType::kInt32 : ScalarType::kUint32, first + 4);
  }
}

/// Hides names that already occur further left. The label column keeps its name and its place at
/// the end.
void make_names_unique(std::vector<ColumnView>& columns, bool has_label, bool has_counts) {
  std::set<std::string> taken = {"rgb", "rgba"};  // what write_pcd adds, what readers take apart
  std::map<std::string, std::string> latest_of;   // by the name that it hides
  if (has_label) taken.insert(columns.back().name);
  const std::size_t count = columns.size() - (has_label ? 1 : 0);
  for (std::size_t c = 0; c < count; ++c) {
    if (has_counts && columns[c].component > 0) {
      columns[c].name = columns[c - 1].name;
      continue;
    }
    // All names between the first of its kind and the latest are taken.
    std::string& latest = latest_of.try_emplace(columns[c].name, columns[c].name).first->second;
    while (!taken.insert(latest).second) latest = hidden(latest);
    columns[c].name = latest;
  }
}

void write_number(double value, ScalarType type, std::byte* to) {
  visit_scalar(type, [&](auto zero) { store(to, static_cast<decltype(zero)>(value)); });
}

void convert_column(const ColumnView& column, const std::byte* from, std::byte* to,
                    std::size_t to_stride, std::size_t count) {
  const bool to_float =
      column.stored == ScalarType::kFloat64 && column.type == ScalarType::kFloat32;
  if (column.stored == column.type) {
    return copy_numbers(from, column.stride, to, to_stride, size_of(column.type), count);
  }
  if (to_float) {  // positions and normals: the case that must be quick
    for (std::size_t i = 0; i < count; ++i) {
      store(to + i * to_stride, static_cast<float>(load<double>(from + i * column.stride)));
    }
    return;
  }
  visit_scalar(column.stored, [&](auto number) {
    for (std::size_t i = 0; i < count; ++i) {
      number = load<decltype(number)>(from + i * column.stride);
      write_number(static_cast<double>(number), column.type, to + i * to_stride);
    }
  });
}

template <typename T>
void append_shortest(T value, std::string& out) {
  std::array<char, 64> digits;
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  out.append(digits.data(), result.ptr);
}

}  // namespace

std::vector<ColumnView> columns_of(const PointCloud& cloud, const ColumnNames& names) {
  check_consistent(cloud);
  std::vector<ColumnView> columns;
  if (cloud.empty()) {
    for (const char* axis : {"x", "y", "z"}) columns.push_back({axis, cloud.position_type});
    return columns;
  }
  add_vectors(columns, cloud.positions, {"x", "y", "z"}, position_type(cloud, names));
  add_normals(columns, cloud, names.normals);
  if (!cloud.colours.empty()) {
    for (std::size_t c = 0; c < names.colours.size(); ++c) {
      columns.push_back({names.colours[c], ScalarType::kUint8,
                         bytes_of(cloud.colours[0].data() + c), sizeof(Rgb), ScalarType::kUint8});
    }
  }
  for (const Attribute* attribute : in_writing_order(cloud)) {
    add_attribute(columns, *attribute, names);
  }
  if (cloud.has_labels()) {
    columns.push_back(
        {"label", names.label_type, bytes_of(cloud.labels.data()), 1, ScalarType::kUint8});
  }
  make_names_unique(columns, cloud.has_labels(), names.has_counts);
  return columns;
}

void check_same_columns(const std::filesystem::path& path, const std::vector<ColumnView>& columns,
                        const std::vector<ColumnView>& others) {
  const auto same = [](const ColumnView& a, const ColumnView& b) {
    return a.name == b.name && a.type == b.type;
  };
  if (!std::equal(columns.begin(), columns.end(), others.begin(), others.end(), same)) {
    throw Error(ErrorKind::kFailure,
                path.string() + ": the parts to write have different attributes");
  }
}

std::size_t row_bytes(const std::vector<ColumnView>& columns) {
  std::size_t bytes = 0;
  for (const ColumnView& column : columns) bytes += size_of(column.type);
  return bytes;
}

void append_binary(const std::vector<ColumnView>& columns, std::size_t begin, std::size_t end,
                   std::string& out) {
  const std::size_t row = row_bytes(columns);
  const std::size_t start = out.size();
  out.resize(start + (end - begin) * row);
  auto* to = reinterpret_cast<std::byte*>(out.data() + start);
  for (const ColumnView& column : columns) {
    convert_column(column, column.first + begin * column.stride, to, row, end - begin);
    to += size_of(column.type);
  }
}

void append_number(ScalarType type, const std::byte* number, std::string& out) {
  visit_scalar(type, [&](auto value) { append_shortest(load<decltype(value)>(number), out); });
}

void append_text(const std::vector<ColumnView>& columns, std::size_t begin, std::size_t end,
                 char separator, std::string& out) {
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c > 0) out += separator;
      std::byte number[8];
      const std::byte* from = columns[c].first + i * columns[c].stride;
      convert_column(columns[c], from, number, 0, 1);
      append_number(columns[c].type, number, out);
    }
    out += '\n';
  }
}

}  // namespace pcednet::io
