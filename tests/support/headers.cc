// SPDX-License-Identifier: BSD-3-Clause
// Nothing of its own: the target that has the tests' precompiled header needs a file.
