(* The random numbers that the engine draws itself; here they come from those of the run. *)
structure CPN'Random = struct
    fun int 0 = raise Div
      | int n = if n > 0 then discrete (0, n - 1) else discrete (n + 1, 0)
    fun int2 n = int n
    val normal = fn (mean, variance) => if variance < 0.0 then 0.0 / 0.0 else normal (mean, variance)
    fun real n = n * uniform (0.0, 1.0)
end
