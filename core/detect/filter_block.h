#pragma once

#include <span>
#include <vector>

#include "core/detect/carried_pairs.h"

namespace cscd {

// Appends to `left`, in order, the feature pairs that the filter (core/elementary/question/filter.h) cannot
// prove apart. Eight pairs are evaluated at a time; for each pair the result is that of the scalar functions
// never_coplanar() and never_meet_in_plane().
void filter(const TriangleMesh& mesh, const Motion& motion, std::span<const FeaturePair> pairs,
            std::vector<FeaturePair>& left);
// The same for the feature pairs that triangle pairs carry; all feature pairs of two triangles are evaluated
// together. If `single_precision_first` is true, single precision is tried first (carried_look.h), which is
// faster and gives the same result.
void filter(const TriangleMesh& mesh, const Motion& motion, std::span<const CarriedPairs> pairs,
            bool single_precision_first, std::vector<FeaturePair>& left);

// Drops feature pairs by the signs of rounded coefficients without their error bounds, as published (Tang
// et al. 2010), one pair at a time. It is an ablation that may drop features that touch (rule
// certain-sign, core/soundness.md).
void drop_by_plain_sign(const TriangleMesh& mesh, const Motion& motion, std::vector<FeaturePair>& pairs);

}  // namespace cscd
