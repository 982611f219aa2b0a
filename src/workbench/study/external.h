#pragma once

#include <string>

#include "pcednet/eval/predictions.h"
#include "workbench/study/plan.h"

namespace pcednet::study {

/// What `method` found in `cloud`; no classes if there is no file for it. Throws what
/// eval::read_predictions() throws.
eval::Predictions external_classes(const ExternalMethod& method, const std::string& set,
                                   const StudyCloud& cloud);

}  // namespace pcednet::study
