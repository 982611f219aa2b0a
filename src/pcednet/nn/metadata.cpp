#include "pcednet/nn/metadata.h"

#include <fmt/format.h>

#include "pcednet/core/error.h"

namespace pcednet::nn {

void Metadata::refuse(const std::string& why) const {
  throw Error(ErrorKind::kModelMismatch, fmt::format("{}: {}", file_, why));
}

void Metadata::refuse_value(const std::string& key, const std::string& value) const {
  refuse(fmt::format("metadata \"{}\" is \"{}\", which this version does not read", key, value));
}

std::string Metadata::take(const std::string& key) {
  const auto found = values_.find(key);
  if (found == values_.end()) refuse(fmt::format("no metadata \"{}\"", key));
  std::string value = std::move(found->second);
  values_.erase(found);
  return value;
}

void Metadata::take_fixed(const std::string& key, std::string_view wanted) {
  const std::string value = take(key);
  if (value == wanted) return;
  refuse(fmt::format("metadata \"{}\" is \"{}\"; this version reads \"{}\"", key, value, wanted));
}

}  // namespace pcednet::nn
