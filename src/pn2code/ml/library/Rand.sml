(* Random numbers of one multiplication, modulo 2^31 - 1: the same in every run. *)
structure Rand = struct
    type rand = word
    val randMin : rand = 0w1
    val randMax : rand = 0wx7FFFFFFE

    fun large (seed : rand) = Word.toLargeInt seed
    fun random (seed : rand) : rand =
        if seed = 0w0 then random randMin
        else if seed = 0wx7FFFFFFF then random randMax
        else Word.fromLargeInt (IntInf.mod (48271 * large seed, 2147483647))
    fun mkRandom (seed : rand) =
        let val last = ref seed in fn () => (last := random (!last); !last) end
    fun norm (seed : rand) = Real.fromLargeInt (large seed) / 2147483647.0
    fun range (low, high) =
        let val last = IntInf.fromInt high - IntInf.fromInt low
        in
            if high < low then raise Fail "Random.range: hi < lo"
            else if high = low then (fn (_ : rand) => low)
            else if last = 2147483647 then Word.toIntX
            else fn seed => IntInf.toInt (IntInf.fromInt low + IntInf.mod (large seed, last + 1))
        end
end
