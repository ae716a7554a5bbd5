"""NumPy, imported when the first array is touched: who meshes files does without its tenth of a second and 20 MB."""


class _NumPy:
    def __getattr__(self, name):
        import numpy
        # Found at once from now on.
        value = self.__dict__[name] = getattr(numpy, name)
        return value


np = _NumPy()
