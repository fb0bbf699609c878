#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/detect/culler.h"
#include "core/detect/detector.h"
#include "core/detect/exclusions.h"
#include "core/detect/start/rest_crossings.h"
#include "core/detect/strategy.h"
#include "core/mesh/vertex_paths.h"
#include "core/session/interval_verdict.h"

namespace cscd {

struct TrueAnswer {
  IntervalVerdict verdict = IntervalVerdict::clear;
  // The verdict is about this span: the proof of a contact, the first closeness, or what is undecided.
  double from = 0, to = 0;
  // Of `close`: no more than this far apart at some time of the span; of all spans the largest such distance.
  double within = 0;
  // Two triangles that come together there; of `touches`, an edge of one of them pierces the other at `to`,
  // or at `from` where `parts_again`, and not at the other end. Where `from` is `to`, two that cross or touch
  // there.
  std::optional<CrossingPair> pair = {};
  bool parts_again = false;
  double deviation = 0;    // the largest bound of any vertex between two jumps; may be infinity
  std::size_t parts = 0;   // parts of the span that were looked at whole
  std::size_t pieces = 0;  // shorter parts in which single feature pairs were looked at
  std::size_t jumps = 0;   // of the motion within the span, between whose sides nothing is asked
};

struct TrueMotionOptions {
  // Features whose distance cannot be told from zero are looked at until it is known to be below this, and
  // for some pieces more: a blade that goes through a thin post within such a distance is told by shorter
  // pieces.
  double resolution = 0;
  // A part is searched as a whole once no vertex leaves its line by more.
  double coarse = 0;
  // Contacts are narrowed down to this share of the span.
  double narrow = 1.0 / 256;
  std::size_t most_parts = 4096, most_pieces = 20'000;
  // Pieces that are looked at below the resolution, of one part that is below it and of the whole span.
  std::size_t more_pieces = 256, most_more_pieces = 2048;
  // Pairs of triangles, and the feature pairs that they alone carry, that are no part of answers; null for
  // none.
  const Exclusions* ignored = nullptr;
  const RestCrossings* left_out = nullptr;  // null for none
};

// The options that fit a mesh with edges of some mean length.
inline TrueMotionOptions true_motion_options(double mean_edge) {
  return {.resolution = 0.01 * mean_edge, .coarse = 0.05 * mean_edge};
}

// Answers spans of time of one surface whose vertices go along known paths.
class TrueMotion {
 public:
  // `strategy` is complete, sees starts and knows distances, and the elementary test of `setup` knows
  // distances and is right where it says "apart". All arguments, and what they refer to, must outlive the
  // object.
  TrueMotion(const VertexPaths& paths, const StrategyInput& setup, const Strategy& strategy,
             const TrueMotionOptions& options);

  // Answers a span at whose start nothing meets but what is left out.
  TrueAnswer answer(double from, double to);
  // Two triangles that meet at a time and are not left out: two that cross, or where none do, two that touch.
  // Where the places of vertices are not known at that time, an answer about a span that starts or ends there
  // is undecided, whatever meets.
  struct Meeting {
    CrossingPair pair;
    bool crosses;
  };
  std::optional<Meeting> meeting_at(double time);
  // The positions of all vertices at a time that was asked about.
  std::span<const Vec3> positions_at(double time);

 private:
  // Places at one time, of all vertices or of those that are looked at.
  struct Places {
    double time = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vec3> at;
    std::vector<double> error;
  };
  struct Piece;

  void place_all(double time, Places& out) const;
  bool is_out(const TrianglePair& pair) const;
  bool is_out(const FeaturePair& pair) const;
  // How far vertices leave their lines, what is uncertain of their places included: each, [vertices], and a
  // bound for all of them.
  std::vector<double> widths(const Places& from, const Places& to) const;
  double largest_width(const Places& from, const Places& to) const;
  // `widest` is the largest width of the part.
  void find_close(const Places& from, const Places& to, double widest);
  // Each returns false once the answer is known.
  bool look_at(const Places& from, const Places& to, double widest);
  bool look_closer(const Places& from, const Places& to, const std::vector<FeaturePair>& pairs);
  bool look_at(Piece& piece, const Places& from, const Places& to, const std::vector<FeaturePair>& pairs);
  bool proves_contact(const Piece& piece, const Places& from, const Places& to,
                      const std::vector<FeaturePair>& pairs);
  bool proves_contact_around(Piece& piece, double end, double reach, const std::vector<FeaturePair>& pairs);
  Places places_of(const Piece& piece, double time) const;
  void say_close(double from, double to, double within, const std::vector<FeaturePair>& pairs);
  bool give_up(double from, double to);
  // Whether features within this distance, which is below the resolution, are looked at in shorter pieces.
  bool look_on(double within);

  const VertexPaths& paths_;
  StrategyInput setup_;
  TrueMotionOptions options_;
  std::unique_ptr<Detector> detector_;
  // Tells whether anything comes close after a clear start; null where signs do not hold.
  std::unique_ptr<Detector> by_signs_;
  std::vector<VertexId> everything_;
  Places last_;  // where the span asked about last ended
  // At this time the pose is clear (core/soundness.md, "Contacts at a distance") at this distance; 0 where
  // that is not known.
  double clear_time_ = std::numeric_limits<double>::quiet_NaN(), clear_at_ = 0;
  int waits_ = 0;                          // parts that are not asked about one distance
  std::uint64_t pairs_without_start_ = 0;  // of triangles, passed on for the last part of an unknown start
  std::vector<Vec3> a_, b_;                // [vertices]: places of those vertices alone that are looked at
  std::vector<double> wide_;               // [vertices]
  ContactSet found_;
  TrueAnswer answer_;
  double narrow_ = 0;
  double stretch_from_ = 0, stretch_to_ = 0;  // the part of the span between two jumps that is looked at
  // Whether it could not be told at the ends of the last piece that was to prove a contact whether some edge
  // meets a face.
  bool unknown_from_ = false, unknown_to_ = false;
  std::size_t ends_left_ = 0;             // of pieces, round which a contact may still be looked for
  bool looks_on_ = false;                 // what is looked at is below the resolution
  std::size_t more_ = 0, more_left_ = 0;  // pieces below it that may still be looked at, there and in all
};

}  // namespace cscd
