#pragma once

#include <type_traits>
#include <utility>

namespace octafront {

template <class Signature>
class FunctionRef;

/// A callable handed down for the time of one call, without a copy of it: for parameters only.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class Callable>
  requires(!std::is_same_v<std::remove_cvref_t<Callable>, FunctionRef>)
      FunctionRef(Callable&& callable)  // NOLINT(google-explicit-constructor): a lambda is passed as it is
      : callable_(const_cast<void*>(static_cast<const void*>(&callable))), call_([](void* c, Arguments... arguments) {
          return static_cast<Result>(
              (*static_cast<std::remove_reference_t<Callable>*>(c))(std::forward<Arguments>(arguments)...));
        }) {}

  Result operator()(Arguments... arguments) const { return call_(callable_, std::forward<Arguments>(arguments)...); }

 private:
  void* callable_;
  Result (*call_)(void*, Arguments...);
};

}  // namespace octafront
