#pragma once

#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>

// Integers of up to 64 `most_words` bits that hold their words in place: nothing is allocated, and products
// are computed by the schoolbook method.
//
// They serve the integers of one elementary query, which have one to forty words, and up to 280 where some
// coordinates are subnormal. At these sizes they are faster than GMP, whose numbers each own a block of
// memory. Words that are not in use are not touched. The caller makes sure beforehand that every result has
// at most kBits bits.
namespace cscd {

template <int most_words>
class WideOf {
 public:
  static constexpr int kWords = most_words;
  static constexpr int kBits = 64 * kWords;

  // Words beyond the size are never read, and clearing them would cost more than most sums.
  WideOf() {}
  WideOf(std::int64_t value) : size_(value != 0), negative_(value < 0) {
    word_[0] = negative_ ? 0 - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
  }
  WideOf(const WideOf& other) : size_(other.size_), negative_(other.negative_) { copy_words(other); }
  WideOf& operator=(const WideOf& other) {
    size_ = other.size_;
    negative_ = other.negative_;
    copy_words(other);
    return *this;
  }

  int sign() const { return size_ == 0 ? 0 : negative_ ? -1 : 1; }
  // The number of bits of the magnitude; 0 for zero.
  int bits() const { return size_ == 0 ? 0 : 64 * size_ - std::countl_zero(word_[size_ - 1]); }

  WideOf operator-() const {
    WideOf result = *this;
    result.negative_ = !negative_;
    return result;
  }
  friend WideOf operator+(const WideOf& a, const WideOf& b) { return sum(a, b, b.negative_); }
  friend WideOf operator-(const WideOf& a, const WideOf& b) { return sum(a, b, !b.negative_); }
  friend WideOf operator*(const WideOf& a, const WideOf& b) {
    WideOf result;
    if (a.size_ == 0 || b.size_ == 0) return result;
    const WideOf &longer = a.size_ < b.size_ ? b : a, &shorter = a.size_ < b.size_ ? a : b;
    assert(a.bits() + b.bits() <= kBits);
    result.negative_ = a.negative_ != b.negative_;
    result.word_[longer.size_] = multiply_word(longer, shorter.word_[0], result.word_);
    for (int i = 1; i < shorter.size_;
         ++i)  // a sum of a large and a tiny part has mostly words that are zero
      result.word_[longer.size_ + i] =
          shorter.word_[i] == 0 ? 0 : add_product_of_word(longer, shorter.word_[i], result.word_ + i);
    result.size_ = a.size_ + b.size_;
    result.size_ -= result.word_[result.size_ - 1] == 0;
    return result;
  }
  friend WideOf operator<<(const WideOf& a, int places) {
    assert(places >= 0);
    if (places == 0 || a.size_ == 0) return a;
    const int words = places / 64, rest = places % 64;
    assert(a.bits() + places <= kBits);
    WideOf result;
    result.negative_ = a.negative_;
    for (int i = 0; i < words; ++i) result.word_[i] = 0;
    if (rest == 0) {
      for (int i = 0; i < a.size_; ++i) result.word_[words + i] = a.word_[i];
      result.size_ = a.size_ + words;
      return result;
    }
    std::uint64_t carry = 0;
    for (int i = 0; i < a.size_; ++i) {
      result.word_[words + i] = a.word_[i] << rest | carry;
      carry = a.word_[i] >> (64 - rest);
    }
    result.size_ = a.size_ + words;
    if (carry != 0) result.word_[result.size_++] = carry;
    return result;
  }

  struct Leading {
    double value;
    int exponent;
  };
  // Returns `value` and `exponent` such that value * 2^exponent is within a relative 2^-52 of the number. The
  // magnitude of `value` is in [1/2, 1]; for zero `value` is 0.
  Leading leading() const {
    if (size_ == 0) return {0, 0};
    const int zeros = std::countl_zero(word_[size_ - 1]);
    std::uint64_t top = word_[size_ - 1] << zeros;
    if (zeros > 0 && size_ > 1) top |= word_[size_ - 2] >> (64 - zeros);
    const double value = static_cast<double>(top) * 0x1p-64;
    return {negative_ ? -value : value, 64 * size_ - zeros};
  }

 private:
  __extension__ typedef unsigned __int128 TwoWords;

  void copy_words(const WideOf& other) {
    for (int i = 0; i < other.size_; ++i) word_[i] = other.word_[i];
  }
  // Writes the magnitude of a times `factor` to `out`, a.size_ words long. Returns the word that is carried.
  static std::uint64_t multiply_word(const WideOf& a, std::uint64_t factor, std::uint64_t* out) {
    std::uint64_t carry = 0;
    for (int i = 0; i < a.size_; ++i) {
      const TwoWords product = static_cast<TwoWords>(a.word_[i]) * factor + carry;
      out[i] = static_cast<std::uint64_t>(product);
      carry = static_cast<std::uint64_t>(product >> 64);
    }
    return carry;
  }
  // Adds the magnitude of a times `factor` to `out`, a.size_ words long. Returns the word that is carried.
  static std::uint64_t add_product_of_word(const WideOf& a, std::uint64_t factor, std::uint64_t* out) {
    std::uint64_t carry = 0;
    for (int i = 0; i < a.size_; ++i) {
      const TwoWords product = static_cast<TwoWords>(a.word_[i]) * factor + carry + out[i];
      out[i] = static_cast<std::uint64_t>(product);
      carry = static_cast<std::uint64_t>(product >> 64);
    }
    return carry;
  }
  static bool smaller_magnitude(const WideOf& a, const WideOf& b) {
    if (a.size_ != b.size_) return a.size_ < b.size_;
    for (int i = a.size_ - 1; i >= 0; --i)
      if (a.word_[i] != b.word_[i]) return a.word_[i] < b.word_[i];
    return false;
  }
  // a + b, with the sign of b given by `b_negative`.
  static WideOf sum(const WideOf& a, const WideOf& b, bool b_negative) {
    const bool swap = smaller_magnitude(a, b);
    const WideOf &large = swap ? b : a, &small = swap ? a : b;
    WideOf result;
    result.negative_ = swap ? b_negative : a.negative_;
    result.size_ = large.size_;
    if (a.negative_ == b_negative) {
      std::uint64_t carry = 0;
      for (int i = 0; i < large.size_; ++i) {
        const TwoWords digit =
            static_cast<TwoWords>(large.word_[i]) + (i < small.size_ ? small.word_[i] : 0) + carry;
        result.word_[i] = static_cast<std::uint64_t>(digit);
        carry = static_cast<std::uint64_t>(digit >> 64);
      }
      assert(carry == 0 || result.size_ < kWords);
      if (carry != 0) result.word_[result.size_++] = carry;
      return result;
    }
    std::uint64_t borrow = 0;
    for (int i = 0; i < large.size_; ++i) {
      const TwoWords digit =
          static_cast<TwoWords>(large.word_[i]) - (i < small.size_ ? small.word_[i] : 0) - borrow;
      result.word_[i] = static_cast<std::uint64_t>(digit);
      borrow = static_cast<std::uint64_t>(digit >> 64) & 1;
    }
    while (result.size_ > 0 && result.word_[result.size_ - 1] == 0) --result.size_;
    return result;
  }

  int size_ = 0;  // words in use; the highest of them is not zero
  bool negative_ = false;
  // The words of two factors can be one more than those of their product.
  std::uint64_t word_[kWords + 1];
};

// The integers of a contact.
using Wide = WideOf<288>;

}  // namespace cscd
