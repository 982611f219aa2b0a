#include "workbench/study/published.h"

namespace pcednet::study {

const std::vector<PublishedRow>& published_rows() {
  using enum eval::Positive;
  static const std::vector<PublishedRow> kRows = {
      {"default", "ca", kEdge, {.490, .880, .506, .628, .752, .457}},
      {"default", "fee", kEdge, {.341, .814, .471, .480, .879, .316}},
      {"default", "fc", kEdge, {.618, .958, .682, .753, .849, .604}},
      {"default", "cnn", kEdge, {.546, .955, .623, .694, .807, .532}},
      {"default", "pcednet", kEdge, {.826, .952, .857, .890, .946, .802}},
      {"default", "pcednet-2c", kSharp, {.364, .611, .402, .430, .908, .274}},
      {"abc", "ca", kSharp, {.348, .944, .520, .504, .881, .338}},
      {"abc", "fee", kSharp, {.135, 1.000, .062, .235, .278, .132}},
      {"abc", "fc", kSharp, {.452, .679, .469, .513, .921, .327}},
      {"abc", "cnn", kSharp, {.530, .995, .648, .689, .922, .519}},
      {"abc", "pcednet", kSharp, {.746, .745, .688, .713, .966, .548}},
      {"abc", "pcednet-2c", kSharp, {.662, .936, .708, .730, .958, .574}},
      {"shrec", "ca", kSharp, {.434, .449, .390, .442, .876, .284}},
      {"shrec", "fee", kSharp, {.191, .527, .151, .278, .727, .160}},
      {"shrec", "fc", kSharp, {.392, .538, .391, .455, .880, .294}},
      {"shrec", "fc", kEdge, {.313, .909, .428, .461, .793, .300}},
      {"shrec", "cnn", kSharp, {.468, .928, .570, .611, .911, .440}},
      {"shrec", "cnn", kEdge, {.299, .945, .429, .446, .802, .287}},
      {"shrec", "pcednet-2c", kSharp, {.462, .623, .455, .510, .868, .342}},
      {"shrec", "pcednet", kSharp, {.495, .377, .344, .437, .916, .280}},
      {"shrec", "pcednet", kEdge, {.349, .898, .444, .489, .814, .323}},
  };
  return kRows;
}

}  // namespace pcednet::study
