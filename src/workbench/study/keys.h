#pragma once

#include <string>

#include "workbench/study/plan.h"

namespace pcednet::study {

// What decides a result, as text: results of equal text are equal.

std::string text_of(const detect::TrainOptions& options);
std::string text_of(const Treatment& treatment);

/// The digests of the clouds.
std::string text_of(const CloudSet& set);

/// The digest of the running program and the vector instructions that it uses: results that another
/// program kept are not taken for those of this one.
std::string this_program();

}  // namespace pcednet::study
