(* Statistics of samples of reals: light ones have sums only, heavy ones an array of all values. *)
structure UnivariateStats = struct
    datatype light = LIGHT
    datatype heavy = HEAVY of real Array.array
    datatype 'a sample = SAMPLE of 'a * int * real * real * real * real
    datatype 'a evaluation = EVALUATION of {own : 'a, size : int, n : real, mean : real, variance : real,
                                            deviation : real, skew : real, kurtosis : real}

    val lempty = SAMPLE (LIGHT, 0, 0.0, 0.0, 0.0, 0.0)
    fun hempty () = SAMPLE (HEAVY (Array.array (1024, 0.0)), 0, 0.0, 0.0, 0.0, 0.0)
    fun summed (x, own, n, s1, s2, s3, s4) =
        let val square = x * x in SAMPLE (own, n + 1, s1 + x, s2 + square, s3 + square * x, s4 + square * square) end
    fun ladd (x, SAMPLE (own, n, s1, s2, s3, s4)) : light sample = summed (x, own, n, s1, s2, s3, s4)
    fun hadd (x, SAMPLE (HEAVY items, n, s1, s2, s3, s4)) =
        let val items =
                if n < Array.length items then items
                else Array.tabulate (2 * n, fn i => if i < n then Array.sub (items, i) else 0.0)
        in Array.update (items, n, x); summed (x, HEAVY items, n, s1, s2, s3, s4) end
    fun evaluate (SAMPLE (own, size, s1, s2, s3, s4)) =
        let val n = real size
            val m = s1 / n
            val square = m * m
            val cube = square * m
            val variance = (s2 + m * (n * m - 2.0 * s1)) / (n - 1.0)
            val deviation = Math.sqrt variance
            val third = s3 - m * (3.0 * (s2 - s1 * m) + n * square)
            val fourth = s4 + m * (6.0 * s2 * m - 4.0 * (s3 + s1 * square) + n * cube)
        in
            EVALUATION {own = own, size = size, n = n, mean = m, variance = variance, deviation = deviation,
                        skew = third / (n * (deviation * variance)),
                        kurtosis = fourth / (n * (variance * variance)) - 3.0}
        end
    fun N (EVALUATION {size, ...}) = size
    fun n (EVALUATION {n, ...}) = n
    fun mean (EVALUATION {mean, ...}) = mean
    fun variance (EVALUATION {variance, ...}) = variance
    fun standardDeviation (EVALUATION {deviation, ...}) = deviation
    fun skew (EVALUATION {skew, ...}) = skew
    fun kurtosis (EVALUATION {kurtosis, ...}) = kurtosis
    fun median (EVALUATION {own = HEAVY items, size, ...}) =
        RealOrderStats.median' (ArraySlice.slice (items, 0, SOME size))
    fun averageDeviation (EVALUATION {own = HEAVY items, size, n, mean, ...}) =
        ArraySlice.foldl (fn (x, sum) => sum + abs (x - mean)) 0.0 (ArraySlice.slice (items, 0, SOME size)) / n
end
