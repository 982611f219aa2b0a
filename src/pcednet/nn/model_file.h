#pragma once

#include <string>

#include "pcednet/nn/model.h"
#include "pcednet/nn/safetensors.h"

namespace pcednet::nn {

/// A model as a safetensors file.
///
/// Tensors: LAYER.weight and LAYER.bias with the shapes PyTorch uses (tree.0.weight is pairs x
/// neurons x inputs), standardisation.mean and standardisation.inverse_deviation (scales x
/// features) and standardisation.bound (1). Metadata: the keys that begin with "nn." describe the
/// network, all others are Model::metadata. Throws Error(kUsage) for a model whose parts do not fit
/// or whose own metadata begins with "nn.".
Safetensors to_safetensors(const Model& model);

/// Throws Error(kModelMismatch), naming the file and what does not fit, unless the file holds
/// exactly the tensors, of exactly the shapes, that its metadata requires, all of them finite.
Model from_safetensors(const Safetensors& content, const std::string& name);

}  // namespace pcednet::nn
