#!/usr/bin/env bash
# fetch_kernel.sh FOLDER: writes Debian's kernel (FOLDER/vmlinuz) and the modules that tests/machine/run.sh loads
# (FOLDER/modules.cpio). The package is unpacked, not installed: 15 MB of its 400 MB, and no boot loader is touched.
set -euo pipefail
folder=$1
modules=(virtio_pci 9pnet_virtio 9p vivid vcan can-raw uvcvideo dummy_hcd gadgetfs)

package=$(LC_ALL=C apt-cache depends linux-image-amd64 | sed -n 's/^ *Depends: *\(linux-image-[0-9].*\)$/\1/p')
[ -n "$package" ] || { echo "fetch_kernel: apt-get update has not been run, or there is no linux-image-amd64" >&2; exit 1; }
version=${package#linux-image-}
wanted="$(apt-cache show --no-all-versions "$package" | sed -n 's/^Version: //p') ${modules[*]}"
if [ "$(cat "$folder/contents" 2>/dev/null)" = "$wanted" ]; then exit 0; fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/package" "$work/root"
(cd "$work/package" && apt-get download "$package")
# Only these folders hold the modules and what they depend on.
parts=(drivers/virtio net/9p fs/9p fs/netfs fs/fscache drivers/media net/can drivers/net/can drivers/usb)
dpkg-deb --fsys-tarfile "$work"/package/*.deb | tar -x -C "$work/root" --wildcards \
  "./boot/vmlinuz-*" "./lib/modules/*/modules.*" "${parts[@]/#/./lib/modules/*/kernel/}"
busybox depmod -b "$work/root" "$version"

cd "$work/root"
library=lib/modules/$version
# A line of modules.dep: a module and those that it needs.
for module in "${modules[@]}"; do
  grep "/${module}[.]ko:" "$library/modules.dep" || { echo "fetch_kernel: $package has no module $module" >&2; exit 1; }
done | tr -d : | tr ' ' '\n' | sort -u >"$work/needed"
{
  printf '%s\n' lib lib/modules "$library" "$library/modules.dep" "$library/modules.builtin"
  sed 's:/[^/]*$::' "$work/needed" | sort -u | while read -r path; do
    while [ "$path" != . ]; do
      echo "$library/$path"
      path=$(dirname "$path")
    done
  done | sort -u
  sed "s:^:$library/:" "$work/needed"
} | busybox cpio -o -H newc >"$work/modules.cpio"
cd - >/dev/null
mkdir -p "$folder"
rm -f "$folder/contents"
mv "$work"/root/boot/vmlinuz-* "$folder/vmlinuz"
mv "$work/modules.cpio" "$folder/modules.cpio"
echo "$wanted" >"$folder/contents"
