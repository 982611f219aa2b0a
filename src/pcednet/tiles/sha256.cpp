#include "pcednet/tiles/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "pcednet/core/error.h"

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
  const auto fail = [&] {
    return Error(ErrorKind::kUnreadable,
                 fmt::format("{}: {}", path.string(), std::strerror(errno)));
  };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"),
                                                             &std::fclose);
  if (!file) throw fail();
  Sha256 digest;
  std::vector<std::byte> some(std::size_t{1} << 20);
  while (const std::size_t read = std::fread(some.data(), 1, some.size(), file.get())) {
    digest.add(std::span(some).first(read));
  }
  if (std::ferror(file.get()) != 0) throw fail();
  return digest.hex();
}

}  // namespace pcednet::tiles
