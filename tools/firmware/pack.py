#!/usr/bin/env python3
"""Signs the linked images and packs them: one ELF with boot loader and slot A for a programmer, the
same as bin files, and the update file, which holds the image of each slot.

    tools/firmware/pack.py build --dir build/release/stm32f405 --key FILE --version 2
    tools/firmware/pack.py sign  --image old.update --key FILE --version 3 --out new.update
    tools/firmware/pack.py keygen FILE

Exit status: 0 done, 2 wrong input."""

import argparse
import os
import struct
import sys
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True

from image import Image  # noqa: E402
from sodium import Key  # noqa: E402

# As firmware/update/image_slot.h has it.
HEADER_BYTES = 512
MAGIC, LAYOUT, FOOT_BOARD = 0x4846494D, 1, 0x46343035
SIGNED = slice(4, 64)
SIGNATURE_AT = 64
VERSION_AT, HASH_AT = 24, 28
LARGEST_VERSION = 0xFFFFFFFE

BOOT_ADDRESS, SLOT_A, SLOT_B = 0x08000000, 0x08020000, 0x08040000


class PackError(Exception):
    pass


def sections(image, *names):
    """The bytes of sections that lie one behind the other in flash, whole words."""
    content = b""
    start = image.section(names[0]).load_address
    for name in names:
        section = image.section(name)
        gap = section.load_address - start - len(content)
        content += b"\xff" * gap + section.content
    return content + b"\xff" * (-len(content) % 4)


def signed(body, slot, version, protocol_hash, key):
    """Header and image. The header's first word is 0: complete."""
    header = bytearray(b"\xff" * HEADER_BYTES)
    fields = [0, MAGIC, LAYOUT, FOOT_BOARD, slot, len(body), version, protocol_hash,
              zlib.crc32(body)] + [0] * 7
    struct.pack_into("<16I", header, 0, *fields)
    header[SIGNATURE_AT:SIGNATURE_AT + 64] = key.sign(bytes(header[SIGNED]) + body)
    return bytes(header) + body


def replaced(elf, image, contents):
    """The ELF file's bytes with sections of the same size filled in."""
    elf = bytearray(elf)
    for name, content in contents.items():
        old = image.section(name)
        offset = old.file_offset
        if len(content) > old.size:
            raise PackError(f"{image.path}: {name} has {old.size} bytes, {len(content)} are needed")
        elf[offset:offset + len(content)] = content
    return bytes(elf)


def write(path, content):
    with open(path + ".new", "wb") as file:
        file.write(content)
    os.replace(path + ".new", path)


def protocol_hash(image):
    symbol = next((s for s in image.symbols if s.name == "hoof_protocol_hash"), None)
    if symbol is None:
        raise PackError(f"{image.path}: no hoof_protocol_hash in it")
    return image.word(symbol.address)


def development_key(folder):
    path = os.path.join(folder, "development.key")
    if not os.path.exists(path):
        Key.generate(path)
        print(f"hoof firmware: made a development key, {path}; boards flashed with it take updates "
              "signed with it alone. For more than trying out: hoof firmware keygen", file=sys.stderr)
    return path


def up_to_date(folder):
    """Whether what was packed is of what is linked now."""
    packed = os.path.join(folder, "hoof-stm32f405.update")  # written last
    linked = [os.path.join(folder, name + ".elf") for name in ("hoof-slot-a", "hoof-slot-b",
                                                               "hoof-boot")]
    return os.path.exists(packed) and all(os.path.getmtime(each) <= os.path.getmtime(packed)
                                          for each in linked)


def build(arguments):
    folder = arguments.dir
    if arguments.if_older and up_to_date(folder):
        return
    key = Key.read(arguments.key or development_key(folder))
    linked = [Image(os.path.join(folder, f"hoof-slot-{slot}.elf")) for slot in "ab"]
    boot_image = Image(os.path.join(folder, "hoof-boot.elf"))
    boot = bytearray(sections(boot_image, ".text", ".key"))
    key_at = boot_image.section(".key").load_address - BOOT_ADDRESS
    boot[key_at:key_at + 32] = key.public
    slots = [signed(sections(image, ".text", ".data"), i, arguments.version, protocol_hash(image),
                    key) for i, image in enumerate(linked)]
    with open(linked[0].path, "rb") as file:
        elf = replaced(file.read(), linked[0], {".boot": bytes(boot),
                                                ".header": slots[0][:HEADER_BYTES]})
    base = os.path.join(folder, "hoof-stm32f405")
    write(base + ".elf", elf)
    write(base + "-boot.bin", bytes(boot))
    write(base + "-slot-a.bin", slots[0])
    write(base + "-spare.bin", b"\xff" * 16)
    write(base + ".update", slots[0] + slots[1])


def images_of(content, path):
    """The images of an update file."""
    images, at = [], 0
    while at < len(content):
        fields = struct.unpack_from("<9I", content, at) if len(content) - at >= 36 else (0, 0)
        if fields[1] != MAGIC or fields[2] != LAYOUT:
            raise PackError(f"{path}: not an update file (byte {at})")
        size = HEADER_BYTES + fields[5]
        image = content[at:at + size]
        if len(image) < size or zlib.crc32(image[HEADER_BYTES:]) != fields[8]:
            raise PackError(f"{path}: cut or damaged (image of slot {'AB'[fields[4] & 1]})")
        images.append((fields, image))
        at += size
    return images


def sign(arguments):
    with open(arguments.image, "rb") as file:
        content = file.read()
    key = Key.read(arguments.key)
    result = b""
    for fields, image in images_of(content, arguments.image):
        version = fields[6] if arguments.version is None else arguments.version
        result += signed(image[HEADER_BYTES:], fields[4], version, fields[7], key)
    write(arguments.out or arguments.image, result)
    print(f"signed as version {version}: {arguments.out or arguments.image}")


def keygen(arguments):
    key = Key.generate(arguments.file)
    print(f"key {arguments.file} (keep it secret, and keep it: boards flashed with it take no other), "
          f"public half {arguments.file}.pub\n{key.public.hex()}")


def version(text):
    value = int(text)
    if not 0 <= value <= LARGEST_VERSION:
        raise argparse.ArgumentTypeError(f"a version is from 0 to {LARGEST_VERSION}, not {text}")
    return value


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    command = commands.add_parser("build")
    command.add_argument("--dir", required=True)
    command.add_argument("--key")
    command.add_argument("--version", type=version, default=1)
    command.add_argument("--if-older", action="store_true", help="than what is linked")
    command.set_defaults(run=build)
    command = commands.add_parser("sign")
    command.add_argument("--image", required=True)
    command.add_argument("--key", required=True)
    command.add_argument("--version", type=version)
    command.add_argument("--out")
    command.set_defaults(run=sign)
    command = commands.add_parser("keygen")
    command.add_argument("file")
    command.set_defaults(run=keygen)
    arguments = parser.parse_args()
    try:
        arguments.run(arguments)
    except (OSError, ValueError, PackError) as error:
        print(f"hoof firmware: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
