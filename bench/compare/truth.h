#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/records/record.h"

namespace cscd::bench {

// Something that the answers of two programs say differently, or that one of them got wrong.
struct TruthFinding {
  std::string scene, row;  // the row is empty where the finding is about the whole scene
  std::string text;
  bool is_lost = false;  // whether the new program is less true; otherwise a change that its guarantee allows
};

// Compares what two programs answered on one scene. All of the new records are held against the first old
// one, on the verified or counted intervals that both have:
// - A failed verification is lost truth.
// - Rows that are complete have to give the same digests of contacts, whatever else they differ in.
// - Rows that promise the first contact have to give the same first time, except where the record says
//   that the start is not embedded. Other contacts may differ. Records without first times are compared by
//   whether there was any contact.
// - The elementary test may not miss, invent or leave undecided more contacts than before, nor tell their
//   times less exactly.
// - All processes of one side have to answer alike.
// Rows whose guarantee is `heuristic` and rows with an elementary test of their own are judged by how many
// contacts of the reference they found.
std::vector<TruthFinding> compare_truth(std::span<const Record> before, std::span<const Record> after);

// How many answers of the two records were compared for this: one a row and counted interval that both have.
std::size_t compared_answers(const Record& before, const Record& after);

}  // namespace cscd::bench
