(* Dates are those of UTC: what a date is of is never read from the clock. *)
structure Date = struct
    datatype weekday = Mon | Tue | Wed | Thu | Fri | Sat | Sun
    datatype month = Jan | Feb | Mar | Apr | May | Jun | Jul | Aug | Sep | Oct | Nov | Dec
    datatype date = DATE of
        {year : int, month : int, day : int, hour : int, minute : int, second : int, offset : Time.time option,
         isDst : bool option}
    exception Date

    val months = [Jan, Feb, Mar, Apr, May, Jun, Jul, Aug, Sep, Oct, Nov, Dec]
    val weekdays = [Mon, Tue, Wed, Thu, Fri, Sat, Sun]
    val month_names =
        ["January", "February", "March", "April", "May", "June", "July", "August", "September", "October", "November",
         "December"]
    val weekday_names = ["Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday"]

    fun number m = let fun at (x :: rest, n) = if x = m then n else at (rest, n + 1) | at (nil, n) = n in at (months, 1) end

    (* Days from the first of March of the year 0 on, and back. *)
    fun days_of (year, month, day) =
        let val y = if month <= 2 then year - 1 else year
            val m = (month + 9) mod 12
        in 365 * y + y div 4 - y div 100 + y div 400 + (153 * m + 2) div 5 + day - 1 end
    fun of_days days =
        let val era = days div 146097
            val rest = days mod 146097
            val y = (rest - rest div 1460 + rest div 36524 - rest div 146096) div 365
            val d = rest - (365 * y + y div 4 - y div 100)
            val m = (5 * d + 2) div 153
            val month = if m < 10 then m + 3 else m - 9
        in (y + era * 400 + (if month <= 2 then 1 else 0), month, d - (153 * m + 2) div 5 + 1) end
    val epoch = days_of (1970, 1, 1)

    fun made (days, seconds, offset, isDst) =
        let val (year, month, day) = of_days (days + seconds div 86400)
            val s = seconds mod 86400
            val _ = if year < 1 then raise Date else ()
        in DATE {year = year, month = month, day = day, hour = s div 3600, minute = s div 60 mod 60, second = s mod 60,
                 offset = offset, isDst = isDst}
        end
    fun date {year, month, day, hour, minute, second, offset} =
        let val shift = case offset of NONE => 0 | SOME t => IntInf.toInt (IntInf.rem (Time.toSeconds t, 86400))
            val s = minute * 60 + second + shift
            val days = days_of (year, number month, 1) + day - 1 + hour div 24
            val kept = case offset of NONE => NONE | SOME _ => SOME (Time.fromSeconds (IntInf.fromInt shift))
        in made (days, hour mod 24 * 3600 + s, kept, NONE) end

    fun year (DATE d) = #year d
    fun month (DATE d) = List.nth (months, #month d - 1)
    fun day (DATE d) = #day d
    fun hour (DATE d) = #hour d
    fun minute (DATE d) = #minute d
    fun second (DATE d) = #second d
    fun offset (DATE d) = #offset d
    fun isDst (DATE d) = #isDst d
    fun days (DATE d) = days_of (#year d, #month d, #day d)
    fun weekday_number d = (days d - epoch + 3) mod 7
    fun weekDay d = List.nth (weekdays, weekday_number d)
    fun yearDay d = days d - days_of (year d, 1, 1)
    fun seconds (DATE d) = #hour d * 3600 + #minute d * 60 + #second d

    (* Times are those of a clock of 32 bits, as in the engine: from 1901 to 2038 backwards, from 1970 on forwards. *)
    val half = IntInf.fromInt 1073741823 + IntInf.fromInt 1
    fun in_clock s = s + half + half >= IntInf.fromInt 0 andalso s - half < half
    fun toTime d =
        let val s = IntInf.fromInt (days d - epoch) * IntInf.fromInt 86400 + IntInf.fromInt (seconds d)
        in if s < IntInf.fromInt 0 orelse not (in_clock s) then raise Date else Time.fromSeconds s end
    fun fromTimeUniv t =
        let val s = Time.toSeconds t
            val day = IntInf.fromInt 86400
            val _ = if in_clock s then () else raise Overflow
            val n = epoch + IntInf.toInt (IntInf.div (s, day))
        in made (n, IntInf.toInt (IntInf.mod (s, day)), SOME Time.zeroTime, SOME false) end
    fun fromTimeLocal t =
        let val d = fromTimeUniv t in if Time.toSeconds t < IntInf.fromInt 0 then raise Date else d end
    fun localOffset () = Time.zeroTime

    fun compare (a, b) =
        case Int.compare (days a, days b) of EQUAL => Int.compare (seconds a, seconds b) | other => other

    fun digits n k = StringCvt.padLeft #"0" k (Int.toString n)
    fun short name = String.substring (name, 0, 3)
    fun weekday_name d = List.nth (weekday_names, weekday_number d)
    fun month_name (DATE d) = List.nth (month_names, #month d - 1)
    fun clock d = digits (hour d) 2 ^ ":" ^ digits (minute d) 2 ^ ":" ^ digits (second d) 2
    fun date_of d =
        short (weekday_name d) ^ " " ^ short (month_name d) ^ " " ^ StringCvt.padLeft #" " 2 (Int.toString (day d))
    (* The engine takes 24 characters of a text of the C library, whatever the length of the year. *)
    fun toString d =
        String.substring (date_of d ^ " " ^ clock d ^ " " ^ Int.toString (year d) ^ "\n\000\000", 0, 24)
    fun written (c, d as DATE {month = m, ...}) =
        case c of
            #"a" => short (weekday_name d)
          | #"A" => weekday_name d
          | #"b" => short (month_name d)
          | #"B" => month_name d
          | #"c" => date_of d ^ " " ^ clock d ^ " " ^ Int.toString (year d)
          | #"d" => digits (day d) 2
          | #"H" => digits (hour d) 2
          | #"I" => digits ((hour d + 11) mod 12 + 1) 2
          | #"j" => digits (yearDay d + 1) 3
          | #"m" => digits m 2
          | #"M" => digits (minute d) 2
          | #"p" => if hour d < 12 then "AM" else "PM"
          | #"S" => digits (second d) 2
          | #"U" => digits ((yearDay d + 7 - (weekday_number d + 1) mod 7) div 7) 2
          | #"w" => Int.toString ((weekday_number d + 1) mod 7)
          | #"W" => digits ((yearDay d + 7 - weekday_number d) div 7) 2
          | #"x" => digits m 2 ^ "/" ^ digits (day d) 2 ^ "/" ^ digits (year d mod 100) 2
          | #"X" => clock d
          | #"y" => digits (year d mod 100) 2
          | #"Y" => Int.toString (year d)
          | #"Z" => (case isDst d of SOME _ => "UTC" | NONE => "")
          | other => String.str other
    fun fmt text d =
        let fun go (#"%" :: c :: rest, out) = go (rest, written (c, d) :: out)
              | go (c :: rest, out) = go (rest, String.str c :: out)
              | go (nil, out) = String.concat (rev out)
        in go (explode text, nil) end

    (* What stands before the year has a place for each character: "Sat Jan  1 00:00:00 ". *)
    fun is_written text =
        let fun all (nil, nil) = true
              | all (#"d" :: form, c :: rest) = Char.isDigit c andalso all (form, rest)
              | all (#"D" :: form, c :: rest) = (c = #" " orelse Char.isDigit c) andalso all (form, rest)
              | all (#"?" :: form, _ :: rest) = all (form, rest)
              | all (x :: form, c :: rest) = x = c andalso all (form, rest)
              | all _ = false
        in all (explode "??? ??? Dd dd:dd:dd ", explode text) end
    fun of_parts (text, year) =
        let fun part i = valOf (Int.fromString (String.substring (text, i, 2)))
            fun find (name, x :: names, m :: rest) = if short x = name then m else find (name, names, rest)
              | find _ = raise Date
            val is_day = List.exists (fn name => short name = String.substring (text, 0, 3)) weekday_names
        in if not is_day then NONE
           else SOME (date {year = year, month = find (String.substring (text, 4, 3), month_names, months),
                       day = part 8, hour = part 11, minute = part 14, second = part 17, offset = NONE})
        end
        handle Date => NONE | Overflow => NONE
    fun fromString text =
        if String.size text < 20 orelse not (is_written (String.substring (text, 0, 20))) then NONE
        else
            case Int.fromString (String.extract (text, 20, NONE)) of
                SOME year => of_parts (text, year)
              | NONE => NONE
    fun scan getc stream =
        let fun take (0, rest, out) = SOME (implode (rev out), rest)
              | take (n, rest, out) = (case getc rest of SOME (c, more) => take (n - 1, more, c :: out) | NONE => NONE)
        in
            case take (20, stream, nil) of
                SOME (text, rest) =>
                    if not (is_written text) then NONE
                    else
                        (case Int.scan StringCvt.DEC getc rest of
                            SOME (year, more) => (case of_parts (text, year) of SOME d => SOME (d, more) | NONE => NONE)
                          | NONE => NONE)
              | NONE => NONE
        end
end
