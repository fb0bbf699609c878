#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/answer/clip_answer.h"
#include "bench/query/view/position_coder.h"
#include "bench/query/view/sections.h"
#include "bench/query/view/strategy_observers.h"

namespace cscd::bench {

// Texts with numbers: equal texts have one number.
class TextTable {
 public:
  std::uint16_t number_of(const std::string& text);  // throws InputError for more than 2^16 texts
  const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::map<std::string, std::uint16_t> known_;
  std::vector<std::string> texts_;
};

// A bit for each triangle in one interval after another, as differences from the interval before.
class ViewBits {
 public:
  void append(const std::vector<bool>& bits);
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_, last_;
};

// Collects where the observers of one cover stood, interval by interval, as places on a grid.
class ObserverRecording {
 public:
  // Adds the observers of one interval. `label` gives the number by which the page knows an observer's
  // cluster.
  void add(const std::vector<RadialView::Observer>& observers, const ViewGrid& grid,
           const std::function<std::uint16_t(std::int32_t)>& label);
  void write(Sections& sections, const std::string& prefix) const;

  const std::vector<std::uint16_t>& clusters() const { return cluster_; }
  const std::vector<std::int16_t>& places() const { return place_; }

 private:
  std::vector<std::uint32_t> count_;    // [intervals]
  std::vector<std::uint16_t> cluster_;  // [observers]
  // [observers][4 points][x, y, z]: the head at the start and at the end of the interval, then the tail at
  // the start and at the end. Coordinates count from the grid's origin in units of four steps of the grid. A
  // point that lies outside what 16 bits hold is moved to the border.
  std::vector<std::int16_t> place_;
};

// Collects what a page shows of one strategy: its answer to each interval, and how its observers saw the
// surface. All arrays are in the order of the intervals that were added.
class StrategyRecording {
 public:
  // Contacts and crossing pairs of triangles that are kept of one interval, the earliest first. The page says
  // how many there are in all.
  static constexpr std::size_t kMostContacts = 2000, kMostStartPairs = 4000;

  // Observers are placed on `grid`, which must outlive the recording, as `answer` must.
  StrategyRecording(const ClipAnswer& answer, const ViewGrid& grid);

  void add(const IntervalAnswer& answer, const scenes::ClipInterval& interval, TextTable& places);
  bool has_clusters() const { return !strategy_observers_.preparation().atomic_cluster.empty(); }

  // Once all intervals are answered: adds all arrays to `sections`, their names behind `prefix`, and returns
  // what else the page has to know.
  nlohmann::json write(Sections& sections, const std::string& prefix) const;

 private:
  void add_contact(const Contact& contact, const Motion& motion, TextTable& places);
  bool is_thick() const { return answer_.input.thickness.length > 0; }
  void add_view(const scenes::ClipInterval& interval);

  const ClipAnswer& answer_;
  StrategyObservers strategy_observers_;
  const ViewGrid& grid_;
  std::vector<std::string> answered_by_;

  // [intervals]
  std::vector<std::uint8_t> verdict_, proven_, answerer_;
  std::vector<float> milliseconds_;
  std::vector<std::uint32_t> contacts_, undecided_, start_pairs_, pairs_, tests_, clusters_, kept_contacts_,
      kept_pairs_;
  // [contacts], several numbers each
  std::vector<std::uint8_t> kind_;          // 0 vertex and face, 1 two edges
  std::vector<std::uint16_t> time_in_;      // in the interval, of 65535
  std::vector<std::uint16_t> along_first_;  // where the point lies on the first edge, of 65535
  std::vector<std::int8_t> normal_;         // x, y, z of 127; zeros where there is none
  std::vector<std::int32_t> vertex_;        // vertex and corners of the face, or the ends of both edges
  std::vector<std::uint16_t> place_;        // of both sides
  std::vector<std::int32_t> crossing_;      // [crossing pairs][2]: triangles
  ViewBits touched_, positive_;             // [intervals][triangles]
  // With a thickness: which triangles have a feature of a pair that is close and does not touch, and which of
  // the contacts touch.
  ViewBits close_;
  std::vector<std::uint8_t> touches_;
  std::vector<std::uint16_t> cluster_of_atomic_;  // [intervals][atomic clusters]
  std::vector<ObserverRecording> observers_;      // [covers in use]
  // The same in every interval: clusters of the covers behind the first, and patches.
  std::vector<std::vector<std::int32_t>> further_covers_;
  std::vector<std::int32_t> patch_;
};

}  // namespace cscd::bench
