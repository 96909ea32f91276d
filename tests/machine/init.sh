#!/bin/busybox sh
# shellcheck shell=dash
# First process of the virtual machine (run.sh): shows the host's files, read-only, and runs /command among them.
export PATH=/bin
/bin/busybox --install -s /bin
mkdir -p /proc /sys /dev /host
stty -opost
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
modprobe -a virtio_pci 9pnet_virtio 9p vcan can-raw
# One device, whose one input is a camera.
modprobe vivid node_types=0x1 num_inputs=1 input_types=0x0
mount -t 9p -o trans=virtio,version=9p2000.L,msize=512000,cache=loose,ro host /host
mkdir -p /dev/shm
mount -t tmpfs shm /dev/shm
for folder in proc sys dev; do mount -o bind /$folder /host/$folder; done
ip link set lo up
ip link add vcan0 type vcan
ip link set vcan0 up
PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin chroot /host /bin/sh -c "$(cat /command)"
echo "machine: exit $?"
reboot -f
