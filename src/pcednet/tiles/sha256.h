#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct evp_md_ctx_st;

namespace pcednet::tiles {

/// SHA-256, for digests that users check with their own tools. Bytes added in pieces count as one
/// message.
class Sha256 {
 public:
  Sha256();

  Sha256& add(std::span<const std::byte> bytes);
  Sha256& add(std::string_view text) { return add(std::as_bytes(std::span(text))); }

  /// 64 digits, as sha256sum prints them. Ends the message.
  std::string hex();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// The SHA-256 of a file's bytes. Throws Error(kUnreadable) if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace pcednet::tiles
