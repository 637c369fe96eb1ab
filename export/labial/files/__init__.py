"""Files: numbers and lines of text, TOML, arrays, frames; an output is whole or untouched."""
