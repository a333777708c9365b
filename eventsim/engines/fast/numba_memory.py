"""Raw memory for kernels: loads, stores and prefetches without bounds checks and reference counts.

An array that is handed to an inlined helper costs atomic reference counting at each call (a third of the rate), so a kernel
takes the pointers of its arrays once, and reads and writes through them.
"""

from __future__ import annotations

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

F64, I64, I32, I8 = ir.DoubleType(), ir.IntType(64), ir.IntType(32), ir.IntType(8)
V8 = ir.VectorType(F64, 8)
i64, f64 = types.int64, types.float64


def place(context, builder, signature, arguments, element, argument=0):
    """The address of an item of a pointer argument, seen as items of type `element`; its index is the next argument."""
    index = context.cast(builder, arguments[argument + 1], signature.args[argument + 1], i64)
    return builder.gep(builder.bitcast(arguments[argument], element.as_pointer()), [index])


def call(builder, name, result, *arguments):
    """A call of an LLVM intrinsic."""
    kind = ir.FunctionType(result, [argument.type for argument in arguments])
    return builder.call(cgutils.get_or_insert_function(builder.module, kind, name), arguments)


@intrinsic
def pointer(typing, array):
    """The pointer to the data of an array; None stays None."""
    if isinstance(array, types.NoneType):
        return types.none(array), lambda context, builder, signature, arguments: context.get_dummy_value()

    def codegen(context, builder, signature, arguments):
        return context.make_array(signature.args[0])(context, builder, arguments[0]).data

    return types.CPointer(array.dtype)(array), codegen


@intrinsic
def either(typing, thing, given, absent):
    """One of two functions: `given` if there is such a thing, `absent` if it is None; the other one is not even compiled."""
    kind = absent if isinstance(thing, types.NoneType) else given
    return kind(thing, given, absent), lambda context, builder, signature, arguments: context.get_dummy_value()


@intrinsic
def real(typing, data, index):
    """The float64 at an index."""
    return f64(data, index), lambda c, b, s, a: b.load(place(c, b, s, a, F64))


@intrinsic
def word(typing, data, index):
    """The int32 at an index, as int64."""
    return i64(data, index), lambda c, b, s, a: b.sext(b.load(place(c, b, s, a, I32)), I64)


@intrinsic
def store(typing, data, index, value):
    """Store a float as float64, an integer as int32."""
    kind, element = (f64, F64) if isinstance(value, types.Float) else (types.int32, I32)

    def codegen(context, builder, signature, arguments):
        value = context.cast(builder, arguments[2], signature.args[2], kind)
        builder.store(value, place(context, builder, signature, arguments, element))
        return context.get_dummy_value()

    return types.void(data, index, value), codegen


@intrinsic
def put_line(typing, data, offset, line):
    """Store a cache line, eight numbers of 64 bits, at an offset in bytes, past the caches: nobody here will read it.

    Its address has to be a multiple of 16.  One of 64 is faster.
    """

    def codegen(context, builder, signature, arguments):
        numbers = [builder.extract_value(arguments[2], k) for k in range(8)]
        whole = ir.Constant(V8, ir.Undefined)
        for k, (number, kind) in enumerate(zip(numbers, signature.args[2], strict=True)):
            if not isinstance(kind, types.Float):
                number = builder.bitcast(context.cast(builder, number, kind, i64), F64)
            whole = builder.insert_element(whole, number, I32(k))
        address = place(context, builder, signature, arguments, I8)
        stored = builder.store(whole, builder.bitcast(address, V8.as_pointer()), align=16)
        stored.set_metadata("nontemporal", builder.module.add_metadata([I32(1)]))
        return context.get_dummy_value()

    return types.void(data, offset, line), codegen


@intrinsic
def prefetch(typing, data, index):
    """Ask for the cache line of the float64 at an index."""

    def codegen(context, builder, signature, arguments):
        line = builder.bitcast(place(context, builder, signature, arguments, F64), I8.as_pointer())
        call(builder, "llvm.prefetch.p0", ir.VoidType(), line, I32(0), I32(3), I32(1))
        return context.get_dummy_value()

    return types.void(data, index), codegen
