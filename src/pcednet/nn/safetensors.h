#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/core/output_file.h"

namespace pcednet::nn {

/// Numbers in row-major order: the last dimension varies fastest.
struct Tensor {
  std::vector<std::size_t> shape;
  std::vector<float> values;
};

/// A safetensors file: named tensors of float32 and a table of texts.
struct Safetensors {
  std::map<std::string, Tensor> tensors;
  std::map<std::string, std::string> metadata;
};

/// The bytes of a file: the same for the same content.
std::string encode_safetensors(const Safetensors& content);

/// Reads the bytes of a file, strictly: every byte must be accounted for.
/// Throws Error(kModelMismatch) with `name` and the byte where it went wrong.
Safetensors decode_safetensors(std::string_view bytes, const std::string& name);

/// Throws Error(kUnreadable) if the file cannot be opened; otherwise as decode_safetensors.
Safetensors read_safetensors(const std::filesystem::path& path);

void write_safetensors(const std::filesystem::path& path, const Safetensors& content,
                       Overwrite overwrite = Overwrite::kNo);

}  // namespace pcednet::nn
