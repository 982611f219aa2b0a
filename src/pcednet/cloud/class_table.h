#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet {

/// The edge classes by number: their names, and their colours, the paper's except for boundary.
struct EdgeClassEntry {
  EdgeClass edge_class;
  std::string_view name;
  Rgb colour;
};
inline constexpr std::array<EdgeClassEntry, 4> kEdgeClasses = {{
    {kNonEdge, "non-edge", {255, 255, 255}},
    {kSmoothEdge, "smooth-edge", {255, 196, 93}},
    {kSharpEdge, "sharp-edge", {168, 0, 0}},
    {kBoundary, "boundary", {0, 82, 165}},
}};
static_assert(kEdgeClasses[kSmoothEdge].edge_class == kSmoothEdge &&
              kEdgeClasses[kSharpEdge].edge_class == kSharpEdge &&
              kEdgeClasses[kBoundary].edge_class == kBoundary);

/// A class that points can have.
struct PointClass {
  std::string name = {};
  Rgb colour = {};
  bool operator==(const PointClass&) const = default;
};

/// The classes of a model, a project or a labelled cloud, by their numbers.
using ClassTable = std::vector<PointClass>;
inline constexpr std::size_t kMostClasses = 8;

/// The kEdgeClasses: the classes of every model that was not trained on others.
const ClassTable& edge_classes();

/// Whether the table begins with the four edge classes, which boundary, context network and lines
/// need.
bool has_edges(const ClassTable& table);

/// Whether there are classes other than the edge classes.
bool has_own_classes(const ClassTable& table);

/// A colour as `#rrggbb`, and back; none for any other text.
std::string text_of(const Rgb& colour);
std::optional<Rgb> colour_of(std::string_view text);

/// The colour of class `id` unless the user chooses another, or has given it to another class.
Rgb usual_colour(std::size_t id);

/// Throws Error(kUsage) unless there are two to eight classes, of different names of one to 40
/// characters in UTF-8.
void check_classes(const ClassTable& table);

/// Reads classes as a user writes them: names separated by commas or line ends, each optionally
/// followed by `=#rrggbb`; the first may be `edges`, which stands for the four edge classes. Throws
/// Error(kUsage) as check_classes().
ClassTable parse_classes(std::string_view text);

/// The table as a user writes it, without colours.
std::string names_of(const ClassTable& table);

/// The table as lines `id #rrggbb name`, and back; none if `lines` are not such a table. Prefixed
/// with `before`, the lines are the comments of a cloud with own classes; parsing skips other
/// comments.
std::vector<std::string> lines_of(const ClassTable& table, std::string_view before = {});
std::optional<ClassTable> table_of(const std::vector<std::string>& lines,
                                   std::string_view before = {});

/// The prefix of each class in a labelled cloud's comments.
inline constexpr std::string_view kClassComment = "pcednet class ";

/// The classes that a labelled cloud's comments name; the edge classes if they name none.
ClassTable classes_of(const std::vector<std::string>& comments);

}  // namespace pcednet
