#pragma once

#include <span>
#include <string>
#include <string_view>

#include "workbench/annotate/messages.h"
#include "workbench/annotate/project/stroke.h"

namespace pcednet::annotate {

// The messages from and to a page, as docs/annotate.md describes them. Files have their own format:
// see project.h.

/// A window that sends a request.
struct Asking {
  bool is_writer = false;
  bool is_open = false;  ///< in this run of the program
};
std::string to_json(const Summary& summary, Asking window);
std::string to_json(std::span<const RunView> runs);
std::string to_json(const Painted& painted);
std::string to_json(const UncertainPlace& place);
std::string to_json(const PointView& point);
std::string to_json(const FileSaved& saved);
std::string to_json(const LinesView& lines);
std::string to_json(const ClassesChanged& changed);

/// "open", "accepted" or "rejected".
const char* decision_name(Decision decision);

/// {"window": its name, "writer": whether it may paint}.
std::string window_json(const std::string& window, bool is_writer);

/// {"error": message}.
std::string error_json(const std::string& message);

/// The name and the data of a server-sent event.
std::string event_name(const Event& event);
std::string event_json(const Event& event);

/// A request for the lines of a cloud.
struct LinesSearch {
  std::size_t cloud = 0;
  bool boundaries = false;  ///< too
};

/// A request to save; an empty name means the default name.
struct SaveRequest {
  std::string what = {}, name = {};
  std::size_t cloud = 0;
  bool overwrite = false;
};

// Requests; a cloud that is not named is the first. These throw Error(kUsage), naming the fault.
Stroke parse_stroke(std::string_view json);
LinesSearch parse_lines_search(std::string_view json);
LinesDecided parse_decision(std::string_view json);
SaveRequest parse_save(std::string_view json);

}  // namespace pcednet::annotate
