"""Raw memory for kernels, and eight pairs at a time in wide registers: one of AVX-512, two of AVX2, four of SSE.

Loads, stores and prefetches have no bounds checks and no reference counts.  An array that is handed to an inlined helper costs
atomic reference counting at each call (a third of the rate), so a kernel takes the pointers of its arrays once, and reads and
writes through them.

Each lane does what `formulas.contact.screened_pair_delay` does, operation by operation and without contraction, so its bits are
those of the scalar kernel and of the reference engine; what is off the path in a lane is computed and thrown away.  Lanes doubt
a little more than the formula, to which doubtful pairs go.
"""

from __future__ import annotations

from llvmlite import binding, ir
from numba import types
from numba.core import cgutils
from numba.core.registry import cpu_target
from numba.extending import intrinsic

from eventsim.engines.fast.layout import REALS, VX, T, X
from eventsim.formulas.contact import DIGITS_LOST, NEAR, SMALLEST
from eventsim.formulas.doubt import CLOCK_BITS

F64, I64, I32, I8 = ir.DoubleType(), ir.IntType(64), ir.IntType(32), ir.IntType(8)
V8 = ir.VectorType(F64, 8)
V2 = ir.VectorType(F64, 2)
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


I16, I1 = ir.IntType(16), ir.IntType(1)
V16, M16 = ir.VectorType(I32, 16), ir.VectorType(I1, 16)
FEATURE = "sse4.2"
"""Every x86-64 processor since 2009 has it.  Lanes are there 1.2 to 1.7 times as fast as the scalar kernel."""

LEAST_LLVM = 19
"""From here on `llvm.experimental.vector.compress` exists."""


SAFE = 2.0**-20
"""How much wider, relative to its own, a lane's doubt is than the formula's: it is computed in fewer operations."""


def lanes_work() -> bool:
    """Whether numba compiles for a processor on which lanes were measured to be faster."""
    features = cpu_target.target_context.codegen().magic_tuple()[2].split(",")
    return binding.llvm_version_info[0] >= LEAST_LLVM and "+" + FEATURE in features


def _mix(builder, a, b, lanes):
    return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(I32, len(lanes)), list(lanes)))


def _splat(builder, value, vector):
    first = builder.insert_element(ir.Constant(vector, ir.Undefined), value, I32(0))
    return _mix(builder, first, first, [0] * vector.count)


@intrinsic
def gather_disks(typing, slots, start, limit, near, count, empty, me, skip):
    """Append the first `limit` of slots[start:start+16], less `empty`, `me` and `skip`, to near[:count]; the new count.

    The list is filled up with `empty` to whole registers.
    """

    def codegen(context, builder, signature, arguments):
        source = place(context, builder, signature, arguments, I32)
        target = place(context, builder, signature, arguments, I32, 3)
        ids = builder.load(builder.bitcast(source, V16.as_pointer()), align=4)
        lane = ir.Constant(V16, list(range(16)))
        keep = builder.icmp_signed("<", lane, _splat(builder, builder.trunc(arguments[2], I32), V16))
        unwanted = [_splat(builder, builder.trunc(value, I32), V16) for value in arguments[5:8]]
        for value in unwanted:
            keep = builder.and_(keep, builder.icmp_signed("!=", ids, value))
        packed = call(builder, "llvm.experimental.vector.compress.v16i32", V16, ids, keep, unwanted[0])
        builder.store(packed, builder.bitcast(target, V16.as_pointer()), align=4)
        kept = call(builder, "llvm.ctpop.i16", I16, builder.bitcast(keep, I16))
        return builder.add(arguments[4], builder.zext(kept, I64))

    return i64(slots, i64, i64, near, i64, i64, i64, i64), codegen


def _two_columns(builder, lines, at):
    """Columns `at` and `at + 1` of eight lines.

    They are put together as they are loaded, two numbers at a time: shuffles of whole registers have one port, loads have two.
    """
    pairs = [builder.load(builder.bitcast(builder.gep(line, [I64(at)]), V2.as_pointer()), align=16) for line in lines]
    fours = [_mix(builder, pairs[k], pairs[k + 2], range(4)) for k in (0, 4, 1, 5)]
    even, odd = _mix(builder, fours[0], fours[1], range(8)), _mix(builder, fours[2], fours[3], range(8))
    return tuple(_mix(builder, even, odd, [lane + one for lane in (0, 8, 2, 10, 4, 12, 6, 14)]) for one in (0, 1))


@intrinsic
def contact_of_eight(
    typing, disks, near, first, x, y, vx, vy, t, r, now, floor, x_now, y_now, length_x, length_y, screen, edge, gx, gy
):
    """(time, disk, many, doubted): the earliest contact of a disk with near[first:first+8], whether several are within
    the screen of it, and a bit for each pair that the plain formula cannot tell about (it does not count then).

    x, y, vx, vy, t, r: the flight of the disk and its radius.  Times before `floor` do not count; inf if there is none.
    edge: 1.0 if the pairs may be across a periodic boundary (then x_now, y_now, length_x, length_y are used; length inf: none
    along this axis); the integer 0 if they cannot be, and the code for it is left out.  gx, gy: the gravity that all fall
    by, so that they fly straight beside each other; or None.
    """
    across, falls = isinstance(edge, types.Float), isinstance(gx, types.Float)

    def codegen(context, b, signature, arguments):
        ids = place(context, b, signature, arguments, I32, 1)
        add, sub, mul = b.fadd, b.fsub, b.fmul

        def every(value):
            return _splat(b, value, V8)

        def constant(value):
            return ir.Constant(V8, [value] * 8)

        def less(p, q):
            return b.fcmp_ordered("<", p, q)

        def position(x, v, lag, g):
            if not falls:
                return add(x, mul(v, lag))
            return add(x, mul(lag, add(v, mul(mul(constant(0.5), g), lag))))

        def velocity(v, lag, g):
            return add(v, mul(g, lag)) if falls else v

        x, y, vx, vy, t, r, now, floor, x_now, y_now, length_x, length_y = map(every, arguments[3:15])
        gx, gy = map(every, arguments[17:19]) if falls else (None, None)
        lines = []
        for lane in range(8):
            disk = b.sext(b.load(b.gep(ids, [I64(lane)])), I64)
            lines.append(b.gep(b.bitcast(arguments[0], F64.as_pointer()), [b.mul(disk, I64(REALS))]))
        (other_x, other_y), (other_vx, other_vy), (other_t, other_r) = (_two_columns(b, lines, at) for at in (X, VX, T))
        begin = b.select(less(other_t, t), t, other_t)
        lag, other_lag = sub(begin, t), sub(begin, other_t)
        dx = sub(position(x, vx, lag, gx), position(other_x, other_vx, other_lag, gx))
        dy = sub(position(y, vy, lag, gy), position(other_y, other_vy, other_lag, gy))
        if across:
            since = sub(now, other_t)

            def shift(here, other, speed, g, length):
                d = sub(here, position(other, speed, since, g))
                half = mul(length, constant(0.5))
                below = b.select(less(d, b.fneg(half)), b.fneg(length), constant(0.0))
                return b.select(less(half, d), length, below)

            dx = sub(dx, shift(x_now, other_x, other_vx, gx, length_x))
            dy = sub(dy, shift(y_now, other_y, other_vy, gy, length_y))
        du = sub(velocity(vx, lag, gx), velocity(other_vx, other_lag, gx))
        dw = sub(velocity(vy, lag, gy), velocity(other_vy, other_lag, gy))
        approach = add(mul(dx, du), mul(dy, dw))
        reach = add(r, other_r)
        reach2 = mul(reach, reach)
        d2 = add(mul(dx, dx), mul(dy, dy))
        c = sub(d2, reach2)
        cross = sub(mul(dx, dw), mul(dy, du))
        a = add(mul(du, du), mul(dw, dw))
        discriminant = sub(mul(a, reach2), mul(cross, cross))
        lost, least = constant(DIGITS_LOST * (1.0 + SAFE)), constant(SMALLEST * (1.0 + SAFE))
        slack = call(b, "llvm.fma.v8f64", V8, lost, mul(a, d2), least)
        apart = less(mul(constant(NEAR * (1.0 + SAFE)), reach2), c)
        told = b.and_(apart, less(slack, call(b, "llvm.fabs.v8f64", V8, discriminant)))
        recedes = less(slack, mul(approach, call(b, "llvm.fabs.v8f64", V8, approach)))
        doubted = b.and_(b.not_(b.or_(told, recedes)), b.fcmp_ordered("ord", other_x, other_x))
        meets = b.and_(told, b.and_(less(approach, constant(0.0)), less(slack, discriminant)))
        root = call(b, "llvm.sqrt.v8f64", V8, discriminant)
        delay = b.fdiv(c, sub(root, approach))
        time = add(begin, delay)
        meets = b.and_(meets, b.fcmp_ordered(">=", time, floor))
        times = smallest = b.select(meets, time, constant(float("inf")))
        for half in (4, 2, 1):
            p, q = _mix(b, smallest, smallest, range(half)), _mix(b, smallest, smallest, range(half, 2 * half))
            smallest = b.select(less(p, q), p, q)
        earliest = b.extract_element(smallest, I32(0))
        hits = b.bitcast(b.fcmp_ordered("==", times, every(earliest)), I8)
        lane = b.and_(b.zext(call(b, "llvm.cttz.i8", I8, hits, I1(0)), I64), I64(7))
        latest = add(mul(constant(CLOCK_BITS), every(earliest)), every(arguments[15]))
        close = b.bitcast(b.fcmp_ordered("<=", times, latest), I8)
        many = b.zext(b.icmp_unsigned("!=", b.and_(close, b.sub(close, I8(1))), I8(0)), I64)
        disk = b.sext(b.load(b.gep(ids, [lane])), I64)
        return context.make_tuple(b, signature.return_type, [earliest, disk, many, b.zext(b.bitcast(doubted, I8), I64)])

    return types.Tuple((f64, i64, i64, i64))(disks, near, i64, *[f64] * 13, edge, gx, gy), codegen
