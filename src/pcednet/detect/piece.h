#pragma once

#include "pcednet/detect/describe.h"
#include "pcednet/detect/model.h"
#include "pcednet/detect/points/prepare.h"

namespace pcednet::detect {

// The experts for few points know whole things: parts, blocks, roofs. Of a piece of a scan with as
// few points they take the rough or cut surface for edges. A model may hold a network that says of
// each description whether it is from a whole or from a piece; its mean log-odds over the cloud
// decide.

/// traits_of() for the choice of a model's experts: a piece counts as a large cloud. Only asked
/// where that changes the expert, and never of a part of a cloud, whose whole decides.
CloudTraits traits_for(const EdgeModel& model, const PreparedCloud& cloud);
CloudTraits traits_for(const EdgeModel& model, const DescribedCloud& cloud);

/// Throws Error(kModelMismatch) unless `pieces` is a model of the classes whole and piece that uses
/// `descriptor`.
void check_pieces(const EdgeModel& pieces, const gls::ScaleSpaceOptions& descriptor);

/// Lets the network of `pieces` tell pieces from wholes. Throws what check_pieces() throws.
void join_pieces(EdgeModel& model, const EdgeModel& pieces);

}  // namespace pcednet::detect
