#pragma once

#include <string>

#include "workbench/study/plan.h"

namespace pcednet::study {

// The determinants of a result, as text: results with equal text are equal.

std::string text_of(const detect::TrainOptions& options);
std::string text_of(const Treatment& treatment);

/// The digests of the clouds.
std::string text_of(const CloudSet& set);

/// The digest of the running program and its vector instructions, so that results of another
/// program are not taken for those of this one.
std::string this_program();

}  // namespace pcednet::study
