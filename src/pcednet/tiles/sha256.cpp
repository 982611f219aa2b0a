#include "pcednet/tiles/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <vector>

#include "pcednet/core/error.h"
#include "pcednet/io/input_file.h"

namespace pcednet::tiles {
namespace {

void expect(int success) {
  if (success != 1) throw Error(ErrorKind::kFailure, "OpenSSL computes no SHA-256 here");
}

}  // namespace

void Sha256::Free::operator()(evp_md_ctx_st* context) const {
  EVP_MD_CTX_free(context);
}

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
  expect(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
}

Sha256& Sha256::add(std::span<const std::byte> bytes) {
  expect(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()));
  return *this;
}

std::string Sha256::hex() {
  std::array<unsigned char, 32> digest;
  expect(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr));
  std::string digits;
  for (const unsigned char byte : digest) digits += fmt::format("{:02x}", byte);
  return digits;
}

std::string sha256_of_file(const std::filesystem::path& path) {
  const io::InputFile file(path);
  Sha256 digest;
  std::vector<std::byte> some(std::size_t{1} << 20);
  for (std::uint64_t at = 0; at < file.size(); at += some.size()) {
    const auto part = std::span(some).first(std::min<std::size_t>(some.size(), file.size() - at));
    file.read(at, part);
    digest.add(part);
  }
  return digest.hex();
}

}  // namespace pcednet::tiles
