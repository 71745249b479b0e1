// SPDX-License-Identifier: BSD-3-Clause
// Numpy arrays in and out: coefficients as modes_x × modes_y, places as rows (x, y).
//
// Each function checks the numbers that it is given: a wrong shape or a number that is not finite
// is Python's ValueError, so that no precondition of the cores breaks.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/basis.h"

namespace ergocast::python {

namespace py = pybind11;

/// Any array-like of numbers; numpy copies and converts it where that is necessary.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

inline py::value_error wrong(const std::string& what) { return py::value_error(what); }

inline void check(bool condition, const std::string& what) {
  if (!condition) throw wrong(what);
}

inline void check_finite(const Numbers& numbers, const std::string& name) {
  const double* const begin = numbers.data();
  for (py::ssize_t i = 0; i < numbers.size(); ++i)
    check(std::isfinite(begin[i]), name + ": every number must be finite");
}

inline double finite(double value, const std::string& name) {
  check(std::isfinite(value), name + ": must be finite");
  return value;
}

/// "(3, 4)", as numpy writes shapes.
inline std::string shape_text(const Numbers& numbers) {
  return py::cast<std::string>(py::str(numbers.attr("shape")));
}

inline Numbers array_of(const Coefficients& coefficients, const Basis& basis) {
  return Numbers({basis.modes_x, basis.modes_y}, coefficients.data());
}

/// @param name  of the argument, for errors
inline Coefficients coefficients_in(const Numbers& numbers, const Basis& basis,
                                    const std::string& name) {
  check(
      numbers.ndim() == 2 && numbers.shape(0) == basis.modes_x && numbers.shape(1) == basis.modes_y,
      name + ": the shape must be (" + std::to_string(basis.modes_x) + ", " +
          std::to_string(basis.modes_y) + "), not " + shape_text(numbers));
  check_finite(numbers, name);
  return Eigen::Map<const Coefficients>(numbers.data(), numbers.size());
}

inline Numbers array_of(const Eigen::Vector3d& in_plane) { return Numbers(2, in_plane.data()); }

/// One place, (x, y).
inline Eigen::Vector2d place_in(const Numbers& numbers, const std::string& name) {
  check(numbers.ndim() == 1 && numbers.shape(0) == 2,
        name + ": the shape must be (2,), not " + shape_text(numbers));
  check_finite(numbers, name);
  return {numbers.at(0), numbers.at(1)};
}

/// Places in rows.
inline std::vector<Eigen::Vector2d> places_in(const Numbers& numbers, const std::string& name) {
  check(numbers.ndim() == 2 && numbers.shape(1) == 2,
        name + ": the shape must be (n, 2), not " + shape_text(numbers));
  check_finite(numbers, name);
  std::vector<Eigen::Vector2d> places;
  for (py::ssize_t i = 0; i < numbers.shape(0); ++i)
    places.emplace_back(numbers.at(i, 0), numbers.at(i, 1));
  return places;
}

}  // namespace ergocast::python
