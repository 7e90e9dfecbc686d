// Wraps functions of Debian's C++ library that write memory which the caller then reads. The memory
// sanitizer does not see these writes, because the library is not compiled with it. The wrappers
// call the library's functions and mark the memory as initialized.
#include <dlfcn.h>
#include <sanitizer/msan_interface.h>

#include <charconv>
#include <map>

namespace {

template <class Function>
Function* library_function(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

std::to_chars_result written(char* first, std::to_chars_result result) {
  __msan_unpoison(first, static_cast<std::size_t>(result.ptr - first));
  return result;
}

}  // namespace

namespace std {

// Only the new node of the tree was uninitialized before.
void _Rb_tree_insert_and_rebalance(bool left, _Rb_tree_node_base* node, _Rb_tree_node_base* parent,
                                   _Rb_tree_node_base& header) noexcept {
  static auto* const call = library_function<decltype(_Rb_tree_insert_and_rebalance)>(
      "_ZSt29_Rb_tree_insert_and_rebalancebPSt18_Rb_tree_node_baseS0_RS_");
  call(left, node, parent, header);
  __msan_unpoison(node, sizeof *node);
}

to_chars_result to_chars(char* first, char* last, float value) noexcept {
  static auto* const call =
      library_function<to_chars_result(char*, char*, float)>("_ZSt8to_charsPcS_f");
  return written(first, call(first, last, value));
}

to_chars_result to_chars(char* first, char* last, double value) noexcept {
  static auto* const call =
      library_function<to_chars_result(char*, char*, double)>("_ZSt8to_charsPcS_d");
  return written(first, call(first, last, value));
}

to_chars_result to_chars(char* first, char* last, double value, chars_format format,
                         int precision) noexcept {
  static auto* const call =
      library_function<to_chars_result(char*, char*, double, chars_format, int)>(
          "_ZSt8to_charsPcS_dSt12chars_formati");
  return written(first, call(first, last, value, format, precision));
}

from_chars_result from_chars(const char* first, const char* last, double& value,
                             chars_format format) noexcept {
  static auto* const call =
      library_function<from_chars_result(const char*, const char*, double&, chars_format)>(
          "_ZSt10from_charsPKcS0_RdSt12chars_format");
  const from_chars_result result = call(first, last, value, format);
  if (result.ec == errc()) {
    __msan_unpoison(&value, sizeof value);
  }
  return result;
}

}  // namespace std
