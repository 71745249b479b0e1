// SPDX-License-Identifier: BSD-3-Clause
// Converts numpy arrays. Coefficients are modes_x × modes_y, positions are rows (x, y). In a box
// they are modes_z × modes_x × modes_y and (x, y, z).
//
// Each function checks its numbers. A wrong shape or a number that is not finite raises Python's
// ValueError, so that no precondition of core/ is broken.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/basis/basis.h"

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

inline std::vector<py::ssize_t> shape_of(const Basis& basis) {
  if (basis.planar()) return {basis.modes_x, basis.modes_y};
  return {basis.modes_z, basis.modes_x, basis.modes_y};
}

/// The number of a position's coordinates.
inline py::ssize_t axes_of(const Box& domain) { return domain.planar() ? 2 : 3; }

inline Numbers array_of(const Coefficients& coefficients, const Basis& basis) {
  return Numbers(shape_of(basis), coefficients.data());
}

/// @param name  of the argument, for errors
inline Coefficients coefficients_in(const Numbers& numbers, const Basis& basis,
                                    const std::string& name) {
  const std::vector<py::ssize_t> shape = shape_of(basis);
  std::string wanted;
  for (const py::ssize_t length : shape) wanted += ", " + std::to_string(length);
  check(std::equal(shape.begin(), shape.end(), numbers.shape(), numbers.shape() + numbers.ndim()),
        name + ": the shape must be (" + wanted.substr(2) + "), not " + shape_text(numbers));
  check_finite(numbers, name);
  return Eigen::Map<const Coefficients>(numbers.data(), numbers.size());
}

inline Numbers array_of(const Eigen::Vector3d& vector, const Box& domain) {
  return Numbers(axes_of(domain), vector.data());
}

/// One place in `domain`.
inline Eigen::Vector3d position_in(const Numbers& numbers, const Box& domain,
                                   const std::string& name) {
  check(numbers.ndim() == 1 && numbers.shape(0) == axes_of(domain),
        name + ": the shape must be (" + std::to_string(axes_of(domain)) + ",), not " +
            shape_text(numbers));
  check_finite(numbers, name);
  return {numbers.at(0), numbers.at(1), domain.planar() ? 0 : numbers.at(2)};
}

/// Places in rows.
inline std::vector<Eigen::Vector3d> positions_in(const Numbers& numbers, const Box& domain,
                                                 const std::string& name) {
  check(numbers.ndim() == 2 && numbers.shape(1) == axes_of(domain),
        name + ": the shape must be (n, " + std::to_string(axes_of(domain)) + "), not " +
            shape_text(numbers));
  check_finite(numbers, name);
  std::vector<Eigen::Vector3d> places;
  for (py::ssize_t i = 0; i < numbers.shape(0); ++i)
    places.emplace_back(numbers.at(i, 0), numbers.at(i, 1), domain.planar() ? 0 : numbers.at(i, 2));
  return places;
}

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
