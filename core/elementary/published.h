#pragma once

#include "core/elementary/question/elementary_test.h"

// The published elementary tests, each in a source of its own. Their answers are no proofs, except where a
// comment says so.
namespace cscd {

// The paper's elementary test (section 7.1): the non-penetration filter, then interval Newton on the
// coplanarity cubic. newton.cpp describes the method and the limits of its answers.
Answer newton_vertex_face(const MovingVertexFace& query);
Answer newton_edge_edge(const MovingEdgeEdge& query);

// The same test in single precision, as games have it. Coordinates are rounded to floats first, which alone
// may move features by 2^-24 of their distance from the origin.
Answer newton_float_vertex_face(const MovingVertexFace& query);
Answer newton_float_edge_edge(const MovingEdgeEdge& query);

// The classic test of cloth simulation (Bridson et al. 2002). `tolerance` is the distance, in extents of the
// relative query, at which features count as touching. The answer is never `undecided`.
Answer cubic_vertex_face(const MovingVertexFace& query, const TestParameters& parameters);
Answer cubic_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters);

// Inclusion-based root finding (Snyder 1992, Wang et al. 2021). `apart` proves that the features never touch.
// `contact` says that at some t at or after the answer's time, which is never later than the first contact,
// the features are within sqrt(3) times the tolerance (and the rounding error of their coordinates) of each
// other. `undecided` is the answer after so many steps; its time is a lower bound too. `tolerance` is in
// extents of the query.
Answer inclusion_vertex_face(const MovingVertexFace& query, const TestParameters& parameters);
Answer inclusion_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters);
// The same at a distance r > 0: `apart` proves that the features are never close. `contact` says that at some
// such t the features are within sqrt(3) times the sum of r and the tolerance.
Answer inclusion_vertex_face_close(const MovingVertexFace& query, double r, const TestParameters& parameters);
Answer inclusion_edge_edge_close(const MovingEdgeEdge& query, double r, const TestParameters& parameters);

// Additive continuous collision detection (Li et al. 2021). `tolerance` is the share of the distance at t = 0
// that counts as touching, in (0, 1). The time is early by as much as the features need for that share.
// Features that touch at t = 0 are in contact then.
Answer additive_vertex_face(const MovingVertexFace& query, const TestParameters& parameters);
Answer additive_edge_edge(const MovingEdgeEdge& query, const TestParameters& parameters);
// The same at a distance r > 0. `tolerance` is the share of the distance beyond r at t = 0 that counts as
// close.
Answer additive_vertex_face_close(const MovingVertexFace& query, double r, const TestParameters& parameters);
Answer additive_edge_edge_close(const MovingEdgeEdge& query, double r, const TestParameters& parameters);

}  // namespace cscd
