#include "spawn/codegen/large_stack.h"

#include <exception>

#ifdef _WIN32
#include <process.h>
#include <windows.h>
#else
#include <pthread.h>
#endif

namespace gpgp::spawn {
namespace {

struct Task {
  const std::function<void()>& work;
  std::exception_ptr error;

  void run() noexcept {
    try {
      work();
    } catch (...) {
      error = std::current_exception();
    }
  }
};

#ifdef _WIN32
unsigned __stdcall runTask(void* task) {
  static_cast<Task*>(task)->run();
  return 0;
}
bool runOnThread(Task& task) {
  const auto thread = reinterpret_cast<HANDLE>(_beginthreadex(nullptr, static_cast<unsigned>(kLargeStack), runTask,
                                                              &task, STACK_SIZE_PARAM_IS_A_RESERVATION, nullptr));
  if (!thread) return false;
  WaitForSingleObject(thread, INFINITE);
  CloseHandle(thread);
  return true;
}
#else
void* runTask(void* task) {
  static_cast<Task*>(task)->run();
  return nullptr;
}
bool runOnThread(Task& task) {
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0) return false;
  pthread_t thread{};
  const bool made = pthread_attr_setstacksize(&attributes, kLargeStack) == 0 &&
                    pthread_create(&thread, &attributes, runTask, &task) == 0;
  pthread_attr_destroy(&attributes);
  return made && pthread_join(thread, nullptr) == 0;
}
#endif
} // namespace

bool onLargeStack(const std::function<void()>& work) {
  Task task{work, nullptr};
  if (!runOnThread(task)) return false;
  if (task.error) std::rethrow_exception(task.error);
  return true;
}

} // namespace gpgp::spawn
