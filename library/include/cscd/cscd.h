#pragma once

#if !defined(__cpp_concepts) || __cpp_concepts < 201907L
#error "cscd/cscd.h needs C++20: compile with -std=c++20 or later"
#elif !defined(__cpp_exceptions)
#error "cscd/cscd.h reports errors as exceptions: compile without -fno-exceptions"
#else

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "cscd/export.h"
#include "cscd/matrix_view.h"
#include "cscd/standard_library.h"

// Continuous self-collision detection of a deforming triangle mesh.
//
//   cscd::SelfCollision body(faces, rest);                     // once a mesh
//   if (!body.is_free(before, after))                          // once a step
//     after = before + body.largest_step(before, after) * (after - before);
//
// The guarantee. In a step every vertex moves in a straight line at constant speed from `start` (t = 0) to
// `end` (t = 1). Two features *touch* if they share a point at some t in [0, 1]; touching counts, nothing has
// to cross. For the coordinates exactly as they are given, as binary floating-point numbers:
//   - is_free() is true only if nothing touches and nothing crosses at the start;
//   - first_contact() gives contacts of the earliest time, at least one, and that time is right to 2^-50;
//   - all_contacts() gives all contacts;
//   - up to largest_step() nothing touches, unless something touches or crosses at the start already;
//   - candidates() holds every pair of features that comes within the radius;
//   - while no vertex moves farther than its vertex_bounds(), along whatever path, nothing touches.
// Features are the vertices, edges and faces of the mesh. A vertex of no face is a feature too: a point that
// touches faces, such as a particle. It takes part in all of this, and true_motion() alone refuses it.
// With a thickness (Options::thickness) above 0, all of this is about pairs of features that come within it:
// wherever a comment says "touches" or "contact", the distance of the two is at most the thickness. Then
//   - is_free() is true only if nothing comes within the thickness and nothing crosses at the start;
//   - up to largest_step() everything stays farther apart than the thickness.
//
// Nothing is sampled, and no tolerance decides. The proofs are in core/soundness.md of the project.
//
// What it costs: preparing a character takes as long as some hundreds of steps without contacts, at times a
// thousand, and preparing cloth as long as some tens. A step takes longer the more of the surface is in
// contact. The README of the project shows times from records.
namespace cscd {

// Lengths have any unit. Times are shares of the step. All errors of the caller are thrown as
// std::invalid_argument with one line that says what is wrong, where, and how to mend it; the object is then
// as it was before. Where the pairs that are found would take more memory than there is, or than `ulimit -v`
// and control groups allow, std::bad_alloc is thrown before memory runs out, and its what() says how many
// pairs there are, how much memory they take, and what to change. It passes through where an allocation
// fails, too. The next steps are then answered as by any other object.
//
// An object may be used by one thread at a time: a call that finds another thread at work throws
// std::logic_error and changes nothing, as does a function given to true_motion() that asks the same object.
// Different objects are independent of each other. The constructor copies what it is given; the positions of
// a step are read during the call alone.
class CSCD_EXPORT SelfCollision {
 public:
  // Positions, one row a vertex. A parameter of this type takes any matrix or expression of Eigen, of doubles
  // or floats, and flat arrays such as std::vector or std::span (matrix_view.h). Doubles that stand row by
  // row are read where they are, others are copied.
  using Positions = MatrixView<double>;
  // Corners of triangles, one row a triangle, counter-clockwise seen from outside; any type of integers.
  using Faces = MatrixView<int>;

  // A surface that the mesh collides with. Obstacles never collide with each other or with themselves. Their
  // positions are no part of a step: an obstacle rests where it is until it is placed elsewhere or moved.
  // Vertices and faces of obstacles are numbered behind those of the mesh, in the order of the obstacles:
  // contacts, crossings, candidates and exclusions name them so.
  struct Obstacle {
    std::vector<std::array<int, 3>> faces;  // corners from 0, in its own positions
    std::vector<std::array<double, 3>> positions;

    Obstacle(const Faces& corners, const Positions& where) {
      corners.require_rows_of_three("obstacle, faces", "triangle");
      where.require_rows_of_three("obstacle, positions", "vertex");
      for (const int* c = corners.data(); faces.size() < corners.rows(); c += 3)
        faces.push_back({c[0], c[1], c[2]});
      for (const double* p = where.data(); positions.size() < where.rows(); p += 3)
        positions.push_back({p[0], p[1], p[2]});
    }
  };

  // What does not count as a collision. Two features may collide if some vertex of one may collide with some
  // vertex of the other. Contacts, crossings at the start and candidates all keep to this. Where there are
  // obstacles, "a vertex" is a vertex of the mesh or of an obstacle.
  struct Exclusions {
    // Vertices that never collide with each other, such as a part of the mesh that the caller moves as one
    // body; empty, or one entry a vertex. Surfaces beside the mesh are Options::obstacles.
    std::vector<bool> rigid;
    // The group of each vertex, any number from 0, and pairs of groups that do not collide; a group may be
    // paired with itself. Pairs name at most 4096 different groups. Empty, or one entry a vertex.
    std::vector<int> group;
    std::vector<std::pair<int, int>> groups_that_ignore_each_other;
    std::vector<std::pair<int, int>> vertex_pairs;
    std::vector<std::pair<int, int>> face_pairs;
    int rings = 0;             // vertices joined by at most so many edges do not collide
    double rest_distance = 0;  // nor do vertices that are nearer than this in the reference positions; finite
    // Whether a step leaves out what lies within an overlap of its start (crossings()): crossings and
    // contacts between two faces on the two sheets of one of its curves. A face is on a sheet of a curve
    // because the curve runs through it there, or because it belongs to a region which that curve bounds
    // there: it has a vertex in the region, or is run through by a curve that bounds it. What is left is new:
    // what touches between two fingers that are both in a thigh, too. Contacts with obstacles always count.
    // Candidates, bounds of vertices and true_motion() keep no account of this. Needs Options::check_start.
    // From a start with overlaps, a step takes the time of crossings() on top, and where the first contact is
    // old, that of all_contacts().
    bool ongoing = false;
  };

  struct Options {
    int threads = 1;  // on which one step is answered, 1 to 1024; answers do not depend on it
    // Whether positions are searched for numbers that are not finite. Switch it off where the caller has done
    // so; the answer to such numbers is then undefined.
    bool check_positions = true;
    // Whether answers say which triangles cross at the start. Without, first_contact() of a closed mesh has
    // to be asked from starts in which nothing crosses.
    bool check_start = true;
    Exclusions exclude;
    std::vector<Obstacle> obstacles;
    // What preparation() of another object with the same faces and reference positions returned. Preparing
    // then takes a fraction of the time. The surface may have been cut, remeshed or refined in places since:
    // faces are known again by the reference positions of their corners, however they are numbered, and what
    // is new is prepared anew. Empty: prepare from nothing.
    std::vector<std::byte> preparation;
    // The part that each vertex belongs to, such as the bone that it follows most: any integers, at most 1000
    // different ones. Parts are taken to turn against each other where they meet. A closed mesh that bends at
    // joints which its reference positions do not show, such as a hand, is then answered in fewer tests;
    // preparing takes two to three times as long. Answers are the same. Empty, or one entry a vertex.
    std::vector<int> labels;
    // How near features may come before they count as contacts, in the unit of the positions: finite and at
    // least 0. Two features that share no vertex and are not excluded are a contact if their distance is at
    // most the thickness at some t in [0, 1]. Where edges are shorter than that, neighbours are close by
    // construction; Exclusions::rings and Exclusions::rest_distance leave them out. With exclusions and a
    // thickness, every question takes the time of a complete search.
    double thickness = 0;
    // More thickness for each vertex, finite and at least 0: a pair has `thickness`, and the sum of the
    // largest of either feature on top, rounded up where a double does not hold it. Empty, or one entry a
    // vertex, of the mesh and then of obstacles.
    std::vector<double> vertex_thickness;
  };

  struct Contact {
    bool edges;  // two edges touch; otherwise a vertex and a face
    // The vertex and the three corners of the face, or the two ends of each edge.
    std::array<int, 4> vertices;
    int face;               // the face, or -1
    double time;            // the earliest time at which the two touch, in [0, 1]
    Eigen::Vector3d point;  // where, at that time, on the first feature
    // The unit vector from the second feature towards the side from which the first came, and at a distance,
    // from the nearest point of the second to that of the first; zero where the features leave no direction.
    Eigen::Vector3d normal;
    // The weights of the face's corners, which sum to 1; or the shares of the way along the first and along
    // the second edge, and zero.
    Eigen::Vector3d weights;
    double normal_velocity;  // of the first feature away from the second, in lengths a step; negative: closer
  };

  struct Answer {
    // Pairs of faces that cross at the start, outside the vertices and edges that they share; the smaller
    // index comes first. Two faces with the same three corners share all that they have, and are no such
    // pair. The contacts are right from such a start too.
    std::vector<std::array<int, 2>> start_crossings;
    std::vector<Contact> contacts;  // by time

    bool intersects_at_start() const { return !start_crossings.empty(); }
    bool free() const { return contacts.empty() && start_crossings.empty(); }
    // The number of pairs that touch, or with a thickness are close, at the start already. The first contacts
    // hold all of them, too.
    std::size_t close_at_start() const {
      std::size_t count = 0;
      while (count < contacts.size() && contacts[count].time <= 0) ++count;
      return count;
    }
    std::optional<double> time() const {
      return contacts.empty() ? std::nullopt : std::optional(contacts.front().time);
    }
  };

  struct Candidates {
    std::vector<std::array<int, 2>> vertex_face;  // a vertex, a face
    std::vector<std::array<int, 4>> edge_edge;    // the two ends of one edge, of another edge
  };

  // How a pose crosses itself: which pieces of the surface lie in each other, how deep, and along which
  // curves.
  struct Crossings {
    // A curve in which two sheets of the surface cross. Which faces follow each other is exact.
    struct Curve {
      std::vector<std::array<int, 2>> faces;  // of each segment: the face of one sheet, of the other sheet
      // The ends of the segments in order: one more than segments, or as many if the curve is closed.
      // Rounded.
      std::vector<Eigen::Vector3d> points;
      bool closed;  // otherwise it ends at borders, or at a vertex where the surface turns inside out
    };
    // What curves cut off one sheet.
    struct Region {
      // The curves of the overlap that bound it, and 0 or 1: on its sheet lies the first or the second face
      // of each pair of the curve's `faces`.
      std::vector<std::array<int, 2>> bounds;
      std::vector<int> vertices;  // from the curves inwards
      // Of each vertex, the way to the nearest point of the skin that was gone through, and how long it is:
      // of all faces of the other component that meet this one or have a vertex in it, and of the flat walls
      // in which these lie; within one component, of what the same curve cuts off. A repair moves vertices
      // along their ways.
      std::vector<Eigen::Vector3d> way;
      std::vector<double> distance;
      double area;  // a third of each face for each of its corners here
      // Behind the faces of the other sheet, inside a closed surface. Otherwise before them, where one closed
      // surface crosses itself and is turned inside out, or looks inward as a whole; or the smaller side,
      // where the other sheet is open.
      bool behind;
      // What is cut off the other sheet is not bounded. Distances are those to the other component, or within
      // one component no more than upper bounds; then `depth` is 0.
      bool other_is_open;
      double depth, depth_bound;  // the largest distance, and what no point of the region exceeds
      int deepest;                // the vertex with the largest distance
      Eigen::Vector3d out;        // its way
    };
    // Curves and regions that hang together. Without regions, no vertex lies in the other sheet; the depth is
    // then that of points between two piercings of an edge. Without curves, a component lies in another one
    // altogether, and touches its wall.
    struct Overlap {
      std::vector<Curve> curves;
      std::vector<Region> regions;  // deepest first
      double depth, depth_bound;
      // The length of the curves, and its gradient: against it, vertices move to shorten the curves.
      // `vertices` are the corners of the edges and faces that pierce each other along the curves. A repair
      // needs this where there are no regions, or where the other sheet is open.
      double length;
      std::vector<int> vertices;
      std::vector<Eigen::Vector3d> gradient;  // [vertices]
    };
    std::vector<Overlap> overlaps;  // deepest first
    std::size_t touching = 0;       // pairs of faces that meet without passing through each other
  };

  // Prepares a mesh. `reference` is any pose without crossings that is not degenerate, such as the pose at
  // rest; the engine chooses where to look from by it, and answers do not depend on it. The mesh may be open,
  // of several pieces, or not manifold; closed meshes are faster. Prepare again when faces change, or when
  // the shape has come far from the reference and steps have become slow.
  SelfCollision(const Faces& faces, const Positions& reference, Options options);
  SelfCollision(const Faces& faces, const Positions& reference)
      : SelfCollision(faces, reference, Options()) {}
  ~SelfCollision();
  SelfCollision(SelfCollision&&) noexcept;
  SelfCollision& operator=(SelfCollision&&) noexcept;

  // Places an obstacle, counted from 0, where it rests in the steps from then on. Moves it: from then on, it
  // moves from `start` to `end` in every step, as the mesh does, until it is placed or moved again. Both cost
  // a pass over all obstacles in the next step; obstacles that rest cost nothing of the kind.
  void place_obstacle(std::size_t obstacle, const Positions& positions);
  void move_obstacle(std::size_t obstacle, const Positions& start, const Positions& end);

  // Returns whether the step is free of contacts, and starts without crossings.
  bool is_free(const Positions& start, const Positions& end);

  // Returns contacts of the earliest time, at least one where anything touches. The second form uses the
  // memory of `out` again: after the largest step so far, a step that starts where a free step ended
  // allocates nothing, unless the surface has left the poses that its clusters were cut for.
  Answer first_contact(const Positions& start, const Positions& end) {
    Answer out;
    first_contact(start, end, out);
    return out;
  }
  void first_contact(const Positions& start, const Positions& end, Answer& out);

  // Returns all contacts.
  Answer all_contacts(const Positions& start, const Positions& end) {
    Answer out;
    all_contacts(start, end, out);
    return out;
  }
  void all_contacts(const Positions& start, const Positions& end, Answer& out);

  // Returns 1 for a free step, otherwise `safety`, in (0, 1], times the earliest time, less by at most 2^-40
  // of it and 2^-48; 0 if something crosses or touches at the start. A result t above 0 means that nothing
  // touches in [0, t] on the exact lines. The positions that you store, such as start + t (end - start), are
  // rounded, and may be off by some units in the last place. Where steps become that short, ask
  // is_free(start, stored), and take a shorter step if it is not.
  double largest_step(const Positions& start, const Positions& end, double safety = 0.9);

  // Returns all pairs of a vertex and a face, and of two edges, that share no vertex and come within `radius`
  // of each other at some t in [0, 1]. Some that do not come that near may be among them. The radius is a
  // length, at least 0 and finite; Options::thickness has no part in it. For a solver that runs a narrow
  // phase of its own.
  Candidates candidates(const Positions& start, const Positions& end, double radius);

  // Returns for each vertex, [vertices of the mesh], how far it may move from where it is in `positions`, in
  // any direction and along any path, so that no two features that are not excluded come as close as the
  // thickness, however all other vertices move within their bounds. Obstacles stay where they are placed or
  // move as they were told. What moves is the position that is stored: where sums round, leave room for that.
  // No bound exceeds `cap`, a finite length of at least 0. Where vertices are far from all others, the time
  // grows with it. Vertices of a pair that is not certainly farther apart than the thickness have the bound
  // 0. From a pose in which nothing crosses, nothing comes to cross.
  std::vector<double> vertex_bounds(const Positions& positions, double cap);

  // Returns how the mesh crosses itself in a pose, obstacles aside. Overlaps of which half of the pairs of
  // faces, or more, are excluded are left out. A piece that lies wholly inside another crosses nothing.
  Crossings crossings(const Positions& positions);

  // Vertices that do not move in straight lines.
  struct Paths {
    // Returns the positions at a time, 3 numbers a vertex, one vertex after the other.
    std::function<std::vector<double>(double time)> positions;
    // Returns an upper bound of how large the acceleration of each vertex is between two times, that is the
    // length of the second derivative of its path: one number for all vertices, or one a vertex; infinity
    // where none is known.
    std::function<std::vector<double>(double from, double to)> acceleration;
    // How far the positions that are returned may be from those on the paths, by rounding; finite and at
    // least 0.
    double position_error = 0;
  };
  struct PathsAnswer {
    enum class Verdict {
      clear,  // proven: nothing touches; and nothing crosses, but what Exclusions let through
      // Proven: an edge pierces a face at one end of the span below and is apart at the other. Or faces
      // touch, without crossing, at the start.
      touches,
      close,                // two features come within a distance, and whether they touch cannot be told
      intersects_at_start,  // faces cross at the start
      undecided             // the bounds of the acceleration do not suffice
    };
    Verdict verdict = Verdict::clear;
    double from = 0, to = 0;           // the span of time that the verdict is about
    double within = 0;                 // of `close`: the largest such distance
    std::array<int, 2> faces{-1, -1};  // two faces that come together, of `touches` and `close`
  };

  // Answers for paths between two times. The promise holds for the paths themselves, if the bounds of the
  // acceleration and the error hold: each vertex stays within acceleration (to - from)^2 / 8 of its straight
  // line, the time is halved until that is short, and contacts are closed in on until they are proven or
  // nearer than `resolution`, a length above 0; 0 stands for a hundredth of the mean edge of the reference
  // positions. For a mesh without obstacles, without a thickness, and without vertices of no face.
  PathsAnswer true_motion(const Paths& paths, double from, double to, double resolution = 0);

  // Returns what preparing the mesh has found out, for Options::preparation of another object. Bytes that are
  // damaged, of another version of the library, or of a mesh that had less than half of the faces, raise
  // std::invalid_argument there, and no others change an answer, so they may come from anywhere. Clusters
  // that have followed the surface are returned as they are now. After a step in which memory ran out, and
  // until the next one, there may be none.
  std::vector<std::byte> preparation() const;

  std::size_t vertex_count() const;  // of the mesh, without obstacles
  std::size_t face_count() const;
  bool closed() const;  // closed, manifold and consistently oriented

  class Engine;  // what answers; the library alone knows it

 private:
  std::unique_ptr<Engine> engine_;
};

// Returns the instruction set that the engine uses: "avx512", "avx2" or "baseline". It is the best that both
// the build and the machine have, or the one that the environment variable CSCD_ISA names when the first
// object is made. Answers are the same with each.
// Throws std::invalid_argument, as the constructor of SelfCollision does, if the build or the machine lacks
// what CSCD_ISA names.
CSCD_EXPORT std::string_view instruction_set();

}  // namespace cscd

#endif
