#pragma once

#include <string>

#include "pcednet/eval/predictions.h"
#include "workbench/study/plan.h"

namespace pcednet::study {

/// The predictions of `method` for `cloud`; no classes if there is no file for it. Throws as
/// eval::read_predictions() does.
eval::Predictions external_classes(const ExternalMethod& method, const std::string& set,
                                   const StudyCloud& cloud);

}  // namespace pcednet::study
