#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bench/records/record.h"

// Times of two rows compare the same work only where both answer alike. This says of which rows that is not
// so; whatever prints times marks theirs with kShortfallMark and says in a footnote what it stands for.
namespace cscd::bench {

inline constexpr std::string_view kShortfallMark = "*";
// What the mark stands for, the mark first and without the full stop.
inline constexpr char kShortfallMeaning[] =
    "* The row does not answer everything that a complete row answers, so its time is not for the same work";

// What a row's answers lack on the verified intervals of a record.
struct Shortfall {
  std::uint64_t contacts_expected = 0, contacts_found = 0;  // those of the reference, and those of them found
  std::size_t intervals = 0;                                // verified
  std::size_t void_intervals = 0;  // of these, with a start that is not embedded: the row promises nothing
};

// Whether anything is lacking at all.
bool is_short(const Shortfall& lacking);

// Returns nothing where the row found all contacts and promises something on every verified interval, and
// where the record did not verify the row.
std::optional<Shortfall> shortfall(const Record& record, std::string_view strategy);
std::optional<Shortfall> shortfall(const VerificationRecord& verification, const VerifiedStrategy& row);

// "kept 374 of 599 contacts; promise void on 34 of 45 intervals", as far as either is so.
std::string shortfall_text(const Shortfall& lacking);

// Whether rows of a guarantee, by its name, promise something only from an embedded start.
bool needs_embedded_start(const std::string& guarantee);

// The footnote to all marks of these records, one line for each scene; empty where there is no mark.
std::string shortfall_note(std::span<const Record> records);

}  // namespace cscd::bench
