#include "scenes/catalog/plain_name.h"

namespace cscd::scenes {
namespace {

constexpr std::size_t kMostNameBytes = 64;

bool is_safe(char c) {
  const bool letter_or_digit = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  const bool of_other_alphabet = (static_cast<unsigned char>(c) & 0x80u) != 0;
  return letter_or_digit || of_other_alphabet || c == '.' || c == '-' || c == '_';
}

// Tells whether a byte continues a character of UTF-8 that an earlier byte began.
bool goes_on(char c) {
  return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u;
}

}  // namespace

std::string plain_name(const std::filesystem::path& path) {
  std::string name = path.stem().string();
  for (char& c : name)
    if (!is_safe(c)) c = '_';
  if (name.empty()) return "unnamed";
  if (name.front() == '.' || name.front() == '-') name.front() = '_';
  if (name.size() > kMostNameBytes) {
    std::size_t end = kMostNameBytes;
    while (end > 0 && goes_on(name[end])) --end;
    name.resize(end);
  }
  return name;
}

}  // namespace cscd::scenes
