// A plugin of QEMU that prints how many instructions the emulated program has executed. Debian has no header of QEMU's
// plugins, so what is used of it is declared here (qemu-plugin.h, version 1 of the interface).
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>

#define EXPORT __attribute__((visibility("default")))

typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id, void (*seen)(qemu_plugin_id_t, struct qemu_plugin_tb*));
uint64_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* block);
void qemu_plugin_register_vcpu_tb_exec_inline(struct qemu_plugin_tb* block, int operation, void* number, uint64_t added);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*ends)(qemu_plugin_id_t, void*), void* unused);

EXPORT int qemu_plugin_version = 1;

static uint64_t executed;

static void count(qemu_plugin_id_t id, struct qemu_plugin_tb* block) {
  (void)id;
  enum { kAdd = 0 };  // QEMU_PLUGIN_INLINE_ADD_U64
  qemu_plugin_register_vcpu_tb_exec_inline(block, kAdd, &executed, qemu_plugin_tb_n_insns(block));
}

static void print(qemu_plugin_id_t id, void* unused) {
  (void)id, (void)unused;
  fprintf(stderr, "instructions %" PRIu64 "\n", executed);
}

EXPORT int qemu_plugin_install(qemu_plugin_id_t id, const void* machine, int words, char** word) {
  (void)machine, (void)words, (void)word;
  qemu_plugin_register_vcpu_tb_trans_cb(id, count);
  qemu_plugin_register_atexit_cb(id, print, 0);
  return 0;
}
