(* What terminals take for colours and styles. *)
structure ANSITerm = struct
    datatype color = Black | Red | Green | Yellow | Blue | Magenta | Cyan | White
    datatype style = FG of color | BG of color | BF | UL | BLINK | REV | INVIS

    fun number Black = 0 | number Red = 1 | number Green = 2 | number Yellow = 3
      | number Blue = 4 | number Magenta = 5 | number Cyan = 6 | number White = 7
    fun code BF = 1 | code UL = 4 | code BLINK = 5 | code REV = 7 | code INVIS = 8
      | code (FG c) = 30 + number c
      | code (BG c) = 40 + number c
    fun toString nil = "\027[0;30m"
      | toString styles = "\027[" ^ String.concatWith ";" (map (Int.toString o code) styles) ^ "m"
    fun setStyle (out, styles) = TextIO.output (out, toString styles)
end
