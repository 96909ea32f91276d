#!/usr/bin/env bash
# run.sh KERNEL_FOLDER COMMAND: runs a shell command as root in a virtual machine with the kernel that fetch_kernel.sh
# has fetched. The command sees this machine's files, read-only; /dev/shm is its own. No KVM, no privileges.
set -euo pipefail
kernel=$1 command=$2

fail_or_skip() {
  if [ -n "${FLEXURA_REQUIRE_KERNEL:-}" ]; then
    echo "failed: needs $1"
    exit 1
  fi
  echo "skipped: needs $1"
  exit 0
}
[ -e "$kernel/contents" ] || fail_or_skip "the kernel that tests/machine/fetch_kernel.sh fetches into $kernel"
for program in qemu-system-x86_64 busybox candump; do
  command -v "$program" >/dev/null || fail_or_skip "$program (group machine of packages.txt)"
done
/usr/bin/python3 -c 'import can' 2>/dev/null || fail_or_skip "Debian's python3-can (group machine of packages.txt)"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/root/bin"
cp "$(command -v busybox)" "$work/root/bin/busybox"
cp "$(dirname "$0")/init.sh" "$work/root/init"
chmod 755 "$work/root/init"
echo virtio_pci 9pnet_virtio 9p vivid vcan can-raw uvcvideo dummy_hcd gadgetfs >"$work/root/modules"
echo "$command" >"$work/root/command"
(cd "$work/root" && find . | busybox cpio -o -H newc 2>/dev/null) >"$work/own.cpio"
cat "$kernel/modules.cpio" "$work/own.cpio" >"$work/initramfs"

timeout 560 qemu-system-x86_64 -M microvm,acpi=off -accel tcg -cpu max -smp 1 -m 512 -nodefaults -no-user-config -display none -no-reboot \
  -kernel "$kernel/vmlinuz" -initrd "$work/initramfs" -append "console=ttyS0 quiet panic=-1 no_timer_check ${MACHINE_APPEND:-}" \
  -serial stdio -fsdev local,id=host,path=/,security_model=none,readonly=on,multidevs=remap \
  -device virtio-9p-device,fsdev=host,mount_tag=host </dev/null | tr -d '\r' | tee "$work/output" || true
status=$(sed -n 's/^machine: exit //p' "$work/output" | tail -n 1)
[ -n "$status" ] || { echo "failed: the virtual machine ended before the command did"; exit 1; }
exit "$status"
