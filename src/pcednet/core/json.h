#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

/// The reader and the writer of JSON, compiled once for all rooms; in sources alone, so that no
/// installed header asks for the library. `Json` sorts members by name; `OrderedJson` keeps their
/// order, and is meant for writing: it looks members up in linear time.
namespace pcednet {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

/// Throws Json::parse_error.
Json parse_json(std::string_view text);
OrderedJson parse_ordered_json(std::string_view text);

/// What the error says, without the "[json.exception.parse_error.101] " of the library.
std::string words_of(const Json::exception& error);

/// The treatment of bytes that are not UTF-8, which names of files may hold.
enum class NotUtf8 {
  kRefuse,   ///< throws Json::type_error
  kReplace,  ///< each becomes U+FFFD
};

/// On one line or, with `indent` spaces a level, on many. Numbers that are not finite become null.
std::string to_text(const Json& json, int indent = -1, NotUtf8 bytes = NotUtf8::kRefuse);
std::string to_text(const OrderedJson& json, int indent = -1, NotUtf8 bytes = NotUtf8::kRefuse);

/// `bytes` as a reader of to_text() gets them, those replaced that are not UTF-8.
std::string as_utf8(const std::string& bytes);

}  // namespace pcednet
