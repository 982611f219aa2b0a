#pragma once

#include "pcednet/core/output_file.h"

namespace pcednet::io {

struct WriteOptions {
  Overwrite overwrite = Overwrite::kNo;
  bool ascii = false;       ///< numbers as text in formats that have both
  bool new_normals = true;  ///< LAS: normals become extra bytes even where the input had none
};

}  // namespace pcednet::io
