#pragma once

#include "pcednet/core/output_file.h"
#include "pcednet/core/progress.h"

namespace pcednet::io {

struct WriteOptions {
  Overwrite overwrite = Overwrite::kNo;
  bool ascii = false;       ///< numbers as text in formats that have both
  bool new_normals = true;  ///< LAS: normals become extra bytes even where the input had none
  /// COPC: progress of the work after the last point has arrived. Null, or outlives the writing.
  const Progress* progress = nullptr;
};

}  // namespace pcednet::io
