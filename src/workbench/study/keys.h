#pragma once

#include <string>

#include "workbench/study/plan.h"

namespace pcednet::study {

// What decides a result, as text: results of equal text are equal.

std::string text_of(const detect::TrainOptions& options);
std::string text_of(const Treatment& treatment);

/// The digests of the clouds.
std::string text_of(const CloudSet& set);

/// What this build of the program computes for a small cloud: descriptions of every kind, trained
/// weights, classes. So results that an older program kept are not taken for those of another one
/// that computes differently. Takes some tens of milliseconds; the same for any number of threads.
std::string behaviour();

}  // namespace pcednet::study
