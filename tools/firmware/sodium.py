"""Ed25519 keys and signatures by libsodium. Debian: libsodium-dev."""

import ctypes
import ctypes.util
import os

SEED_BYTES, PUBLIC_BYTES, SECRET_BYTES, SIGNATURE_BYTES = 32, 32, 64, 64

_sodium = None


def _library():
    global _sodium
    if _sodium is None:
        name = ctypes.util.find_library("sodium")
        if name is None:
            raise OSError("libsodium is not installed: apt-get install libsodium-dev")
        _sodium = ctypes.CDLL(name)
        if _sodium.sodium_init() < 0:
            raise OSError("libsodium cannot be started")
    return _sodium


class Key:
    """A signing key. The file holds its 32-byte seed in hexadecimal, for its owner alone."""

    def __init__(self, seed):
        public = ctypes.create_string_buffer(PUBLIC_BYTES)
        self._secret = ctypes.create_string_buffer(SECRET_BYTES)
        _library().crypto_sign_seed_keypair(public, self._secret, seed)
        self.public = public.raw

    @staticmethod
    def generate(path):
        """Makes a key and its file, and the public half beside it as PATH.pub.

        Raises FileExistsError where either is there: a lost key locks its boards for good."""
        for each in (path, path + ".pub"):
            if os.path.exists(each):
                raise FileExistsError(f"{each} exists; a key is never written over")
        seed = os.urandom(SEED_BYTES)
        key = Key(seed)
        for name, content, mode in ((path, seed, 0o600), (path + ".pub", key.public, 0o644)):
            with os.fdopen(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "w") as file:
                file.write(content.hex() + "\n")
        return key

    @staticmethod
    def read(path):
        with open(path, encoding="ascii", errors="replace") as file:
            text = file.read().strip()
        try:
            seed = bytes.fromhex(text)
        except ValueError:
            seed = b""
        if len(seed) != SEED_BYTES:
            raise ValueError(f"{path}: not a key; {2 * SEED_BYTES} hexadecimal digits are expected "
                             "(hoof firmware keygen makes one)")
        return Key(seed)

    def sign(self, message):
        signature = ctypes.create_string_buffer(SIGNATURE_BYTES)
        _library().crypto_sign_detached(signature, None, message,
                                        ctypes.c_ulonglong(len(message)), self._secret)
        return signature.raw


def verify(signature, message, public):
    return _library().crypto_sign_verify_detached(
        signature, message, ctypes.c_ulonglong(len(message)), public) == 0
