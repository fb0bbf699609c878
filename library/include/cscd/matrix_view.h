#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <limits>
#include <ranges>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace cscd {

// Scalars whose every value a view of `Number` can hold, or can refuse: a view of double takes float, and a
// view of int takes any integer.
template <class Scalar, class Number>
concept ReadableAs = std::same_as<Scalar, Number> ||
                     (std::same_as<Number, double>&& std::same_as<Scalar, float>) ||
                     (std::same_as<Number, int> && std::integral<Scalar> && !std::same_as<Scalar, bool>);

// Matrices and expressions of Eigen that have three columns, or a number of columns known at run time alone.
template <class Matrix>
concept MayHaveThreeColumns = int(Matrix::ColsAtCompileTime) == 3 ||
                              int(Matrix::ColsAtCompileTime) == Eigen::Dynamic;

// The numbers of a matrix, row by row, as one call reads them. A call takes a matrix or an expression of
// Eigen, or a flat array: a contiguous range of three numbers for each row, such as std::vector or std::span.
//
// The view refers to the caller's numbers where they are of type `Number` and stand row by row without gaps.
// Otherwise the view holds a copy. The view does not know which argument it is, so it keeps what is wrong
// with the numbers or their shape, and require_rows_of_three() throws where the name of the argument is
// known.
template <class Number>
class MatrixView {
 public:
  template <class Derived>
  requires MayHaveThreeColumns<Derived> && ReadableAs<typename Derived::Scalar, Number> MatrixView(
      const Eigen::DenseBase<Derived>& matrix)
      : rows_(static_cast<std::size_t>(matrix.rows())), columns_(static_cast<std::size_t>(matrix.cols())) {
    using Scalar = typename Derived::Scalar;
    if constexpr (std::same_as<Scalar, Number> && (int(Derived::Flags) & int(Eigen::DirectAccessBit)) != 0) {
      const Derived& direct = matrix.derived();
      if (direct.colStride() == 1 && direct.rowStride() == direct.cols()) {
        numbers_ = direct.data();
        return;
      }
    }
    const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values(matrix.derived());
    read(values.data(), static_cast<std::size_t>(values.size()));
  }

  template <std::ranges::contiguous_range Flat>
  requires ReadableAs<std::ranges::range_value_t<Flat>, Number> &&
      (!requires { Flat::ColsAtCompileTime; })MatrixView(const Flat& flat)
      : rows_(std::ranges::size(flat) / 3), columns_(3) {
    const std::size_t size = std::ranges::size(flat);
    if (size % 3 != 0)
      defect_ = std::to_string(size) + " numbers are no whole rows; give three numbers for each row";
    if constexpr (std::same_as<std::ranges::range_value_t<Flat>, Number>)
      numbers_ = std::ranges::data(flat);
    else
      read(std::ranges::data(flat), size);
  }

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  // Row by row, rows() times columns() numbers.
  const Number* data() const { return copy_.empty() ? numbers_ : copy_.data(); }

  // Throws std::invalid_argument unless there are rows of three numbers that a `Number` can hold. The text
  // begins with `name`, and says that there is a row for each `what`. To be called before data() is read.
  void require_rows_of_three(std::string_view name, std::string_view what) const {
    if (columns_ == 3 && defect_.empty()) return;
    if (columns_ == 3) throw std::invalid_argument(std::string(name) + ": " + defect_);
    std::string hint = "; give one row of three for each ";
    hint += what;
    if (rows_ == 3 && columns_ > 4) hint += ": transpose the matrix";
    if (columns_ == 4 && std::same_as<Number, int>) hint += ": split quads into triangles";
    throw std::invalid_argument(std::string(name) + ": " + std::to_string(rows_) + " rows of " +
                                std::to_string(columns_) + " columns" + hint);
  }

 private:
  template <class Scalar>
  void read(const Scalar* values, std::size_t count) {
    copy_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      if constexpr (std::integral<Scalar>)
        if (!std::in_range<Number>(values[i])) {
          defect_ = "triangle " + std::to_string(i / columns_) + " names vertex " +
                    std::to_string(values[i]) + "; an index is at most " +
                    std::to_string(std::numeric_limits<Number>::max());
          return;
        }
      copy_[i] = static_cast<Number>(values[i]);
    }
  }

  std::size_t rows_, columns_;
  const Number* numbers_ = nullptr;
  std::vector<Number> copy_;
  std::string defect_;  // what is wrong with the numbers, or empty
};

}  // namespace cscd
