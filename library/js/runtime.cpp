// What Debian's runtime for WebAssembly leaves out or does slowly: above all the part that throws and
// catches.
//
// The compiler turns `throw` into __cxa_throw(). WebAssembly unwinds the stack by itself and hands the value
// of
// __builtin_wasm_throw() to each frame that may catch. Such a frame asks _Unwind_CallPersonality() which of
// its clauses takes the exception, unless its only clause is `catch (...)`. The names and layouts are those
// of the Itanium C++ ABI as clang uses them for WebAssembly. There is one thread.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <typeinfo>

namespace __cxxabiv1 {

// The classes of libc++abi behind std::type_info. The functions before can_catch() keep their places.
class __shim_type_info : public std::type_info {
 public:
  ~__shim_type_info() override;
  virtual void noop1() const;
  virtual void noop2() const;
  // Returns whether a clause of this type takes an object of the other, and moves `object` to the base.
  virtual bool can_catch(const __shim_type_info* thrown, void*& object) const = 0;
};

}  // namespace __cxxabiv1

namespace {

using Type = __cxxabiv1::__shim_type_info;

// Stands before each object that is thrown.
struct alignas(std::max_align_t) Exception {
  const Type* type;
  void* (*destroy)(void*);  // destructors return the object
  void* caught;             // the object, as the type of the clause that takes it
  Exception* outer;         // the exception that was being handled when this one was caught
  int handlers;             // how many handlers run; negative while the exception is thrown again

  void* object() { return this + 1; }
};

Exception* g_handled = nullptr;

[[noreturn]] void raise(Exception* exception) {
  __builtin_wasm_throw(0, exception);
}

std::uintptr_t read_unsigned(const std::uint8_t*& at) {
  std::uintptr_t number = 0;
  for (unsigned shift = 0;; shift += 7) {
    const std::uint8_t byte = *at++;
    number |= static_cast<std::uintptr_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return number;
  }
}

std::intptr_t read_signed(const std::uint8_t*& at) {
  std::uintptr_t number = 0;
  for (unsigned shift = 0;;) {
    const std::uint8_t byte = *at++;
    number |= static_cast<std::uintptr_t>(byte & 0x7f) << shift;
    shift += 7;
    if (byte >= 0x80) continue;
    if ((byte & 0x40) != 0 && shift < 8 * sizeof number) number |= ~std::uintptr_t{0} << shift;
    return static_cast<std::intptr_t>(number);
  }
}

// Returns the number of the first clause that takes the exception, or 0. `table` describes the clauses of one
// function: an encoding and the offset of its types, the chains of clauses of its landing pads, and the
// clauses.
std::uintptr_t clause_for(Exception& exception, const std::uint8_t* table, std::uintptr_t landing_pad) {
  table += 2;  // encodings of the start of landing pads, which has none, and of types, which are addresses
  const std::uintptr_t offset = read_unsigned(table);
  const auto* const types = reinterpret_cast<const Type* const*>(table + offset);
  ++table;  // the encoding of landing pads, which are numbers
  const std::uintptr_t size = read_unsigned(table);
  const std::uint8_t* const clauses = table + size;
  std::uintptr_t first = 0;
  for (std::uintptr_t pad = 0; pad <= landing_pad; ++pad) read_unsigned(table), first = read_unsigned(table);
  if (first == 0) return 0;
  for (const std::uint8_t* at = clauses + first - 1;;) {
    const std::intptr_t clause = read_signed(at);
    const std::uint8_t* const from = at;
    const std::intptr_t next = read_signed(at);
    if (clause > 0) {
      const Type* const type = types[-clause];
      exception.caught = exception.object();
      if (type == nullptr || type->can_catch(exception.type, exception.caught))
        return static_cast<std::uintptr_t>(clause);
    }
    if (next == 0) return 0;
    at = from + next;
  }
}

}  // namespace

extern "C" {

struct {
  std::uintptr_t landing_pad;
  const std::uint8_t* table;
  std::uintptr_t clause;
} __wasm_lpad_context;

int _Unwind_CallPersonality(void* exception) {
  auto& context = __wasm_lpad_context;
  context.clause = clause_for(*static_cast<Exception*>(exception), context.table, context.landing_pad);
  return 0;
}

void* __cxa_allocate_exception(std::size_t size) noexcept {
  void* const memory = std::malloc(sizeof(Exception) + size);
  if (memory == nullptr) std::terminate();
  return static_cast<Exception*>(memory) + 1;
}

void __cxa_free_exception(void* object) noexcept {
  std::free(static_cast<Exception*>(object) - 1);
}

[[noreturn]] void __cxa_throw(void* object, std::type_info* type, void* (*destroy)(void*)) {
  Exception* const exception = static_cast<Exception*>(object) - 1;
  *exception = {static_cast<const Type*>(type), destroy, object, nullptr, 0};
  raise(exception);
}

void* __cxa_get_exception_ptr(void* exception) noexcept {
  return static_cast<Exception*>(exception)->caught;
}

void* __cxa_begin_catch(void* thrown) noexcept {
  auto* const exception = static_cast<Exception*>(thrown);
  exception->handlers = std::abs(exception->handlers) + 1;
  if (exception != g_handled) {
    exception->outer = g_handled;
    g_handled = exception;
  }
  return exception->caught;
}

void __cxa_end_catch() {
  Exception* const exception = g_handled;
  const bool thrown_again = exception->handlers < 0;
  exception->handlers += thrown_again ? 1 : -1;
  if (exception->handlers != 0) return;
  g_handled = exception->outer;
  if (thrown_again) return;
  if (exception->destroy != nullptr) exception->destroy(exception->object());
  __cxa_free_exception(exception->object());
}

[[noreturn]] void __cxa_rethrow() {
  if (g_handled == nullptr) std::terminate();
  g_handled->handlers = -g_handled->handlers;
  raise(g_handled);
}

// The runtime's functions for integers of 128 bits are compiled with these guards of the stack.
std::uintptr_t __stack_chk_guard = 0x5ca1ab1e;
[[noreturn]] void __stack_chk_fail() {
  std::terminate();
}

// Where a step starts is compared with where the last one ended, and the runtime compares byte by byte.
int memcmp(const void* first, const void* second, std::size_t size) {
  const auto *a = static_cast<const std::uint8_t*>(first), *b = static_cast<const std::uint8_t*>(second);
  for (std::uint64_t x, y; size >= sizeof x; a += sizeof x, b += sizeof x, size -= sizeof x) {
    std::memcpy(&x, a, sizeof x), std::memcpy(&y, b, sizeof y);
    if (x != y) break;
  }
  for (; size > 0; ++a, ++b, --size)
    if (*a != *b) return *a - *b;
  return 0;
}

}  // extern "C"

// The runtime's own operators end the program where no memory is left.
void* operator new(std::size_t size) {
  if (void* const memory = std::malloc(std::max<std::size_t>(size, 1))) return memory;
  throw std::bad_alloc();
}

void* operator new(std::size_t size, std::align_val_t alignment) {
  const std::size_t unit = std::max(static_cast<std::size_t>(alignment), sizeof(void*));
  if (void* const memory =
          std::aligned_alloc(unit, (std::max<std::size_t>(size, 1) + unit - 1) / unit * unit))
    return memory;
  throw std::bad_alloc();
}
