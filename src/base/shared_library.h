// A library that is opened at run time, so that the program starts fast and works without it.
#pragma once

#include <dlfcn.h>

#include <string>

#include "base/diagnostic.h"

namespace aircut {

/// Opens a library for good. Error kind `output_failed`, with the remedy.
inline Expected<void*> open_library(const std::string& name, const std::string& remedy) {
  if (void* library = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) return library;
  const char* why = dlerror();
  return unexpected(
      make_error("output_failed",
                 "can't open " + name + " (" + (why ? why : "unknown reason") + "); " + remedy));
}

/// False when `library` has no function of that name.
template <class F>
bool find_function(void* library, const char* name, F& function) {
  function = reinterpret_cast<F>(dlsym(library, name));
  return function != nullptr;
}

}  // namespace aircut
