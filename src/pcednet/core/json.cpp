#include "pcednet/core/json.h"

namespace pcednet {
namespace {

template <typename AnyJson>
std::string text_of(const AnyJson& json, int indent, NotUtf8 bytes) {
  using Handler = typename AnyJson::error_handler_t;
  return json.dump(indent, ' ', false,
                   bytes == NotUtf8::kReplace ? Handler::replace : Handler::strict);
}

}  // namespace

Json parse_json(std::string_view text) {
  return Json::parse(text);
}

OrderedJson parse_ordered_json(std::string_view text) {
  return OrderedJson::parse(text);
}

std::string words_of(const Json::exception& error) {
  const std::string_view words = error.what();
  const std::size_t end = words.find("] ");
  return std::string(words.starts_with('[') && end != words.npos ? words.substr(end + 2) : words);
}

std::string to_text(const Json& json, int indent, NotUtf8 bytes) {
  return text_of(json, indent, bytes);
}

std::string to_text(const OrderedJson& json, int indent, NotUtf8 bytes) {
  return text_of(json, indent, bytes);
}

std::string as_utf8(const std::string& bytes) {
  return parse_json(to_text(Json(bytes), -1, NotUtf8::kReplace)).get<std::string>();
}

}  // namespace pcednet
