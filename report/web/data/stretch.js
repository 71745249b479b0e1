// SPDX-License-Identifier: BSD-3-Clause
// Chooses by what factor a flat box is drawn higher than it is.
const NICE = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];

export function stretchOf([lx, ly, lz]) {
  const wanted = Math.max(lx, ly) / lz / 4;
  return NICE.findLast(factor => factor <= Math.max(1, 2 * wanted - 1));
}
