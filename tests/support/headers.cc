// SPDX-License-Identifier: BSD-3-Clause
// Empty: the target with the tests' precompiled header needs a source file.
