"""What writes docs/measured."""
