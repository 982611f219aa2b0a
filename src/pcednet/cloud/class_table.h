#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/edge_class.h"

namespace pcednet {

/// A class that points can have.
struct PointClass {
  std::string name = {};
  Rgb colour = {};
  bool operator==(const PointClass&) const = default;
};

/// The classes of a model, a project or a labelled cloud, by their numbers.
using ClassTable = std::vector<PointClass>;
inline constexpr std::size_t kMostClasses = 8;

/// Those of kEdgeClasses: the classes of every model unless it was trained on others.
const ClassTable& edge_classes();

/// Whether the table begins with the four edge classes: boundary, context and lines are of these.
bool has_edges(const ClassTable& table);

/// Whether there are other classes than those of edges.
bool has_own_classes(const ClassTable& table);

/// `#rrggbb`, and back; none for any other text.
std::string text_of(const Rgb& colour);
std::optional<Rgb> colour_of(std::string_view text);

/// The colour of class `id` unless the user chooses another.
Rgb usual_colour(std::size_t id);

/// Throws Error(kUsage) unless there are two to eight classes, of different names of one to 40
/// characters in UTF-8.
void check_classes(const ClassTable& table);

/// Reads classes as a user writes them: names with commas or line ends between them, each may be
/// followed by `=#rrggbb`; the first may be `edges`, which stands for the four edge classes. Throws
/// Error(kUsage) as check_classes().
ClassTable parse_classes(std::string_view text);

/// The table as a user writes it, without colours.
std::string names_of(const ClassTable& table);

/// The table as lines `id #rrggbb name`, and back; none if `lines` are no such table. With `before`
/// in front of each they are the comments of a cloud of own classes, among others.
std::vector<std::string> lines_of(const ClassTable& table, std::string_view before = {});
std::optional<ClassTable> table_of(const std::vector<std::string>& lines,
                                   std::string_view before = {});

/// What stands in front of each class in a labelled cloud's comments.
inline constexpr std::string_view kClassComment = "pcednet class ";

/// The classes that a labelled cloud's comments name; those of edges if they name none.
ClassTable classes_of(const std::vector<std::string>& comments);

}  // namespace pcednet
