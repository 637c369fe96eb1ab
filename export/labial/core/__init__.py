"""The C library through ctypes. Needs only Python."""
