// SPDX-License-Identifier: BSD-3-Clause
// Functions of a library that is opened while the program runs.
#pragma once

#include <dlfcn.h>

#include <type_traits>

namespace ergocast {

/// Sets `function` to the function of that name. False if the library and what it loads have none.
/// @param handle  of dlopen()
template <class Function>
bool find_symbol(void* handle, const char* name, Function& function) {
  void* const found = dlsym(handle, name);
  function = reinterpret_cast<std::remove_reference_t<Function>>(found);
  return found != nullptr;
}

}  // namespace ergocast
