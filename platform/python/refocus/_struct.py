"""What all structs of parameters share: defaults of the library, and no names but theirs."""
import typing

from . import _core


class Struct:
    """Fields of a struct of the library, by their names there."""

    _name: typing.ClassVar[str]

    def __init__(self, **fields: typing.Any) -> None:
        vars(self).update(_core.struct_default(self._name))
        if 'band' in self.__annotations__:
            vars(self)['band'] = []
        self.set(**fields)

    def set(self, **fields: typing.Any) -> None:
        """Set several fields at once."""
        for name, value in fields.items():
            setattr(self, name, value)

    def __setattr__(self, name: str, value: typing.Any) -> None:
        if name not in self.__annotations__:
            raise AttributeError(f'{type(self).__name__} has no {name}; it has '
                                 + ', '.join(self.__annotations__))
        vars(self)[name] = value

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and vars(self) == vars(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        fields = ', '.join(f'{name}={value!r}' for name, value in vars(self).items())
        return f'{type(self).__name__}({fields})'


Made = typing.TypeVar('Made', bound=Struct)


def made(kind: type[Made], fields: dict[str, typing.Any]) -> Made:
    """A struct that the library filled."""
    struct = kind.__new__(kind)
    vars(struct).update(fields)
    return struct
