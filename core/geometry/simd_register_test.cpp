#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "core/geometry/simd_doubles.h"
#include "core/geometry/simd_registers.h"
#include "core/geometry/simd_shorts.h"

// Compares several registers of each size, and what this machine uses, with single numbers.
namespace cscd {

namespace {

template <class Vector>
using NumberOf = std::remove_cvref_t<decltype(Vector{}[0])>;

// Returns few different values, so that equal ones meet. For floating point they include values whose
// comparison is special: NaN, -0 and infinities.
template <class Vector>
Vector drawn(std::mt19937& random) {
  using Number = NumberOf<Vector>;
  Vector v{};
  for (std::size_t l = 0; l < sizeof(Vector) / sizeof(Number); ++l) {
    const int draw = static_cast<int>(random() % 40);
    v[l] = static_cast<Number>(draw - 20);
    if constexpr (std::is_floating_point_v<Number>) {
      using Limits = std::numeric_limits<Number>;
      if (draw < 4)
        v[l] = std::array{Limits::quiet_NaN(), -Number{0}, Limits::infinity(), -Limits::infinity()}[draw];
    }
  }
  return v;
}

template <class Number>
bool same(Number a, Number b) {
  if constexpr (std::is_floating_point_v<Number>)
    return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
  else
    return a == b;
}

template <class Vector>
class Vectors : public testing::Test {
 protected:
  using Number = NumberOf<Vector>;
  static constexpr std::size_t kCount = sizeof(Vector) / sizeof(Number);

  // expected(a, b) gives a lane's result from the lane's numbers.
  template <class Result, class Expected>
  void expect(const Result& result, const Expected& expected) const {
    for (std::size_t l = 0; l < kCount; ++l)
      ASSERT_TRUE(same<NumberOf<Result>>(result[l], static_cast<NumberOf<Result>>(expected(a_[l], b_[l]))))
          << l;
  }
  void draw() { a_ = drawn<Vector>(random_), b_ = drawn<Vector>(random_); }

  std::mt19937 random_{2014};
  Vector a_, b_;
};

template <class Number>
using Two = Registers<Number, 64, 32>;
template <class Number>
using Four = Registers<Number, 64, 16>;

using Types = testing::Types<Two<float>, Two<double>, Two<std::int16_t>, Two<std::int32_t>, Two<std::int64_t>,
                             Four<float>, Four<double>, Four<std::int16_t>, Four<std::int32_t>,
                             Four<std::int64_t>, Registers<float, 32, 16>, Float16, Lane8, Short32, Int16,
                             Sign8, HalfOf<float>, HalfOf<std::uint16_t>>;
TYPED_TEST_SUITE(Vectors, Types);

TYPED_TEST(Vectors, WorkLaneByLane) {
  using Number = typename TestFixture::Number;
  for (int round = 0; round < 200; ++round) {
    this->draw();
    const auto &a = this->a_, &b = this->b_;
    const auto updated = [&](const auto& update) {
      TypeParam v = a;
      update(v);
      return v;
    };
    this->expect(a + b, [](Number x, Number y) { return x + y; });
    this->expect(a - b, [](Number x, Number y) { return x - y; });
    this->expect(a * b, [](Number x, Number y) {
      if constexpr (std::is_integral_v<Number>)
        return static_cast<Number>(std::int64_t{x} * y);  // the product of two shorts exceeds an int
      else
        return x * y;
    });
    this->expect(-a, [](Number x, Number) { return -x; });
    this->expect(a + Number{3}, [](Number x, Number) { return x + 3; });
    this->expect(-Number{0} * TypeParam{} - a, [](Number x, Number) { return -Number{0} * 0 - x; });
    if constexpr (std::is_floating_point_v<Number>) {
      this->expect(a / b, [](Number x, Number y) { return x / y; });
      this->expect(updated([&](TypeParam& v) { v -= b; }), [](Number x, Number y) { return x - y; });
      this->expect(updated([&](TypeParam& v) { v *= b; }), [](Number x, Number y) { return x * y; });
      this->expect(a - (-Number{0} - TypeParam{}), [](Number x, Number) { return x + 0; });
    } else {
      this->expect(a & b, [](Number x, Number y) { return x & y; });
      this->expect(a | b, [](Number x, Number y) { return x | y; });
      this->expect(~a, [](Number x, Number) { return ~x; });
      this->expect(a >> 2, [](Number x, Number) { return x >> 2; });
      this->expect(a << 2, [](Number x, Number) { return x << 2; });
      this->expect(updated([&](TypeParam& v) { v &= b; }), [](Number x, Number y) { return x & y; });
      this->expect(updated([&](TypeParam& v) { v |= b; }), [](Number x, Number y) { return x | y; });
    }
    this->expect(updated([&](TypeParam& v) { v += b; }), [](Number x, Number y) { return x + y; });
  }
}

TYPED_TEST(Vectors, CompareAndSelectLaneByLane) {
  using Number = typename TestFixture::Number;
  for (int round = 0; round < 200; ++round) {
    this->draw();
    const auto &a = this->a_, &b = this->b_;
    this->expect(a < b, [](Number x, Number y) { return -(x < y); });
    this->expect(a > b, [](Number x, Number y) { return -(x > y); });
    this->expect(a <= b, [](Number x, Number y) { return -(x <= y); });
    this->expect(a >= b, [](Number x, Number y) { return -(x >= y); });
    this->expect(a == b, [](Number x, Number y) { return -(x == y); });
    this->expect(a != b, [](Number x, Number y) { return -(x != y); });
    this->expect(select(a < b, a, b), [](Number x, Number y) { return x < y ? x : y; });
    this->expect(select((a < b) | (a == b), b, a), [](Number x, Number y) { return x <= y ? y : x; });
    // Either of 0 and -0 may be taken, and either number if one of them is NaN.
    const TypeParam least = smaller(a, b), most = larger(a, b);
    for (std::size_t l = 0; l < this->kCount; ++l) {
      if (a[l] != a[l] || b[l] != b[l]) continue;
      ASSERT_EQ(least[l], std::min<Number>(a[l], b[l]));
      ASSERT_EQ(most[l], std::max<Number>(a[l], b[l]));
    }
  }
}

TYPED_TEST(Vectors, KeepAndConvertTheirNumbers) {
  using Number = typename TestFixture::Number;
  constexpr TypeParam kFirst = {1, 2, 3};
  for (std::size_t l = 0; l < this->kCount; ++l) ASSERT_EQ(kFirst[l], l < 3 ? Number(l + 1) : Number{0});
  this->draw();
  TypeParam copy{};
  for (std::size_t l = 0; l < this->kCount; ++l) copy[l] = this->a_[l];
  this->expect(copy, [](Number x, Number) { return x; });
  if constexpr (std::is_same_v<Number, std::int32_t>) {
    using Floats =
        std::conditional_t<std::is_same_v<TypeParam, Two<Number>>, Two<float>,
                           std::conditional_t<std::is_same_v<TypeParam, Four<Number>>, Four<float>, Float16>>;
    this->expect(converted<Floats>(this->a_), [](Number x, Number) { return static_cast<float>(x); });
    this->expect(bits_as<Floats>(this->a_), [](Number x, Number) { return std::bit_cast<float>(x); });
  }
  if constexpr (std::is_same_v<Number, double>) {
    const TypeParam finite = select(this->a_ - this->a_ == Number{0}, this->a_ / 3, TypeParam{});
    using Narrow = std::conditional_t<std::is_same_v<TypeParam, Lane8>, HalfOf<float>,
                                      std::conditional_t<std::is_same_v<TypeParam, Four<Number>>,
                                                         Registers<float, 32, 16>, VectorOf<float, 32>>>;
    const auto narrow = converted<Narrow>(finite);
    const TypeParam back = converted<TypeParam>(narrow);
    for (std::size_t l = 0; l < this->kCount; ++l) {
      ASSERT_EQ(narrow[l], static_cast<float>(finite[l]));
      ASSERT_EQ(back[l], static_cast<double>(narrow[l]));
    }
  }
}

// The shuffles take from one register, from two of both operands or of one, and from three and four.
TEST(Shuffles, TakeFromAnyRegisters) {
  const auto expect = []<int... kFrom>(std::integer_sequence<int, kFrom...>, auto a, auto b) {
    constexpr int kCount = sizeof...(kFrom);
    for (int l = 0; l < kCount; ++l) a[l] = static_cast<float>(l), b[l] = static_cast<float>(kCount + l);
    const auto out = shuffled<kFrom...>(a, b);
    const int from[] = {kFrom...};
    for (int l = 0; l < kCount; ++l) ASSERT_EQ(out[l], static_cast<float>(from[l])) << l;
  };
  const auto both = [&]<int... kFrom>(std::integer_sequence<int, kFrom...> from) {
    expect(from, Float16{}, Float16{});
    expect(from, Two<float>{}, Two<float>{});
    expect(from, Four<float>{}, Four<float>{});
  };
  both(std::integer_sequence<int, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7>{});
  both(std::integer_sequence<int, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29>{});
  both(std::integer_sequence<int, 31, 2, 2, 30, 29, 0, 1, 1, 15, 8, 9, 16, 17, 23, 14, 8>{});
  both(std::integer_sequence<int, 0, 4, 8, 12, 16, 20, 24, 28, 15, 7, 23, 7, 15, 23, 0, 16>{});
  both(std::integer_sequence<int, 5, 30, 12, 16, 12, 30, 5, 31, 9, 9, 9, 9, 9, 9, 9, 9>{});
}

TEST(Lanes16, PermutedTakesAnyLane) {
  std::mt19937 random(2014);
  for (int round = 0; round < 200; ++round) {
    const Float16 v = drawn<Float16>(random);
    Places16 place;
    for (std::uint8_t& p : place) p = static_cast<std::uint8_t>(random() % kLanes16);
    const Float16 out = permuted(v, place);
    for (std::size_t l = 0; l < kLanes16; ++l) ASSERT_TRUE(same<float>(out[l], v[place[l]])) << l;
  }
}

TEST(Lanes16, PointsAreTakenWhole) {
  std::mt19937 random(2014);
  const Float16 axis[3] = {drawn<Float16>(random), drawn<Float16>(random), drawn<Float16>(random)};
  const Points16 points(axis);
  Places16 place;
  for (std::uint8_t& p : place) p = static_cast<std::uint8_t>(random() % kLanes16);
  Float16 out[3];
  points.take(place, out);
  for (int i = 0; i < 3; ++i)
    for (std::size_t l = 0; l < kLanes16; ++l)
      ASSERT_TRUE(same<float>(out[i][l], axis[i][place[l]])) << i << " " << l;
}

TEST(Lanes, AreLoadedAndStoredInOrder) {
  std::array<float, kLanes16> numbers, back;
  for (std::size_t l = 0; l < kLanes16; ++l) numbers[l] = static_cast<float>(l);
  const auto v = loaded<Float16>(numbers.data());
  for (std::size_t l = 0; l < kLanes16; ++l) ASSERT_EQ(v[l], numbers[l]);
  store(v, back.data());
  EXPECT_EQ(back, numbers);
  const auto high = half_of<Float8, 1>(v);
  for (std::size_t l = 0; l < 8; ++l) ASSERT_EQ(high[l], numbers[8 + l]);
}

// Every lane takes part once: a sum of sixteen powers of two shows which.
TEST(Lanes16, FoldedCombinesEveryLaneOnce) {
  Float16 v;
  for (std::size_t l = 0; l < kLanes16; ++l) v[l] = static_cast<float>(1U << l);
  EXPECT_EQ(folded(v, [](auto a, auto b) { return a + b; }), 65535.0F);
}

TEST(Lanes16, ComparisonsGiveOneBitALane) {
  std::mt19937 random(2014);
  for (int round = 0; round < 200; ++round) {
    const Float16 a = drawn<Float16>(random), b = drawn<Float16>(random);
    const Short32 c = drawn<Short32>(random), d = drawn<Short32>(random);
    const Sign8 e = drawn<Sign8>(random) & 1;
    std::array<std::int32_t, kLanes16> f, g;
    for (std::size_t l = 0; l < kLanes16; ++l) f[l] = random() % 3, g[l] = random() % 3;
    const unsigned floats = above(a, b), integers = equal(f, g), shorts = above(c, d), signs = bits_of(-e);
    for (std::size_t l = 0; l < 32; ++l) ASSERT_EQ(shorts >> l & 1, c[l] > d[l]) << l;
    for (std::size_t l = 0; l < kLanes16; ++l) ASSERT_EQ(floats >> l & 1, a[l] > b[l]) << l;
    for (std::size_t l = 0; l < kLanes16; ++l) ASSERT_EQ(integers >> l & 1, f[l] == g[l]) << l;
    for (std::size_t l = 0; l < kLanes; ++l) ASSERT_EQ(signs >> l & 1, static_cast<unsigned>(e[l])) << l;
    ASSERT_EQ(bits_of(e), bits_of(-e));  // a lane may be 1 or -1
  }
}

// smaller() and larger() give the same for lanes as for single numbers, with zeros and NaN too: vector code
// relies on that to equal its scalar counterpart bit for bit. Mutation: the arguments are exchanged.
template <class Lanes>
void expect_order_of_one_number() {
  using Number = std::remove_cvref_t<decltype(Lanes{}[0])>;
  const Number all[] = {0, -Number{0}, 1, -2, std::numeric_limits<Number>::quiet_NaN()};
  for (const Number x : all)
    for (const Number y : all) {
      const Lanes a = x - Lanes{}, b = y - Lanes{};
      const Number least = smaller(a, b)[0], most = larger(a, b)[0];
      EXPECT_EQ(std::isnan(least), std::isnan(smaller(x, y)));
      EXPECT_EQ(std::signbit(least), std::signbit(smaller(x, y)));
      EXPECT_EQ(std::isnan(most), std::isnan(larger(x, y)));
      EXPECT_EQ(std::signbit(most), std::signbit(larger(x, y)));
    }
}
TEST(Lanes, SmallerAndLargerAreThoseOfOneNumber) {
  expect_order_of_one_number<Float16>();
  expect_order_of_one_number<Lane8>();
}

TEST(Lanes, JoinedHasBothHalvesInOrder) {
  const Float16 v = joined<Float16>(Float8{0, 1, 2, 3, 4, 5, 6, 7}, Float8{8, 9, 10, 11, 12, 13, 14, 15});
  for (std::size_t l = 0; l < kLanes16; ++l) EXPECT_EQ(v[l], static_cast<float>(l));
}

#ifdef __FMA__
TEST(Lanes8, RoundedOnceIsThatOfOneNumber) {
  std::mt19937 random(2014);
  std::uniform_real_distribution<double> any(-2, 2);
  for (int round = 0; round < 200; ++round) {
    Lane8 a, b, c;
    for (std::size_t l = 0; l < kLanes; ++l) a[l] = any(random), b[l] = any(random), c[l] = -a[l] * b[l];
    const Lane8 lost = rounded_once(a, b, c);
    for (std::size_t l = 0; l < kLanes; ++l) ASSERT_EQ(lost[l], std::fma(a[l], b[l], c[l])) << l;
  }
}
#endif

TEST(Lanes16, ArithmeticIsThatOfOneNumber) {
  std::mt19937 random(2014);
  std::uniform_real_distribution<float> any(-2, 2);
  for (int round = 0; round < 200; ++round) {
    Float16 a, b, c;
    for (std::size_t l = 0; l < kLanes16; ++l) a[l] = any(random), b[l] = any(random), c[l] = any(random);
    const Float16 plus = product_plus(a, b, c), minus = product_minus(a, b, c),
                  root = square_root(absolute(a)), size = larger_size(a, b);
    const auto one_of = [](float got, float once, float twice) { return got == once || got == twice; };
    for (std::size_t l = 0; l < kLanes16; ++l) {
      ASSERT_TRUE(one_of(plus[l], std::fma(a[l], b[l], c[l]), a[l] * b[l] + c[l]));
      ASSERT_TRUE(one_of(minus[l], std::fma(a[l], b[l], -c[l]), a[l] * b[l] - c[l]));
      ASSERT_EQ(root[l], std::sqrt(std::abs(a[l])));
      ASSERT_EQ(size[l], std::max(std::abs(a[l]), std::abs(b[l])));
    }
  }
}

// The numbers of a pair stand side by side, the first one first, with their signs. Mutations: one of the two
// is lost; they are exchanged; the sign of the first one runs over into the second.
TEST(Shorts32, RoundedPairsHoldBothNumbers) {
  Float16 a{}, b{};
  for (std::size_t l = 0; l < kLanes16; ++l) {
    a[l] = 1000.3F * static_cast<float>(l) - 8000;
    b[l] = 7000 - 900.3F * static_cast<float>(l);
  }
  for (const float scale : {1.0F, 0.25F, 4.0F}) {
    const Short32 pairs = rounded_pairs(a, b, scale);
    for (std::size_t l = 0; l < kLanes16; ++l) {
      EXPECT_NEAR(static_cast<float>(pairs[2 * l]), scale * a[l], 0.51F) << l;
      EXPECT_NEAR(static_cast<float>(pairs[2 * l + 1]), scale * b[l], 0.51F) << l;
    }
  }
}

}  // namespace

}  // namespace cscd
