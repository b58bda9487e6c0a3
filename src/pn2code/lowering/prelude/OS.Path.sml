val OS_Path_parentArc = ".."
val OS_Path_currentArc = "."

fun arcs_of text = if text = "" then nil else String.fields (fn c => c = #"/") text

fun OS_Path_isAbsolute path = String.isPrefix "/" path
fun OS_Path_isRelative path = not (OS_Path_isAbsolute path)
fun OS_Path_isRoot path = path = "/"

fun OS_Path_fromString path =
    if OS_Path_isAbsolute path then {isAbs = true, vol = "", arcs = arcs_of (String.extract (path, 1, NONE))}
    else {isAbs = false, vol = "", arcs = arcs_of path}

fun joined (arcs, absolute) =
    if not absolute andalso (case arcs of "" :: _ => true | _ => false) then raise OS.Path.Path
    else if List.exists (fn arc => String.isSubstring "/" arc) arcs then raise OS.Path.InvalidArc
    else (if absolute then "/" else "") ^ String.concatWith "/" arcs

fun OS_Path_toString {isAbs, vol, arcs} = if vol <> "" then raise OS.Path.Path else joined (arcs, isAbs)

fun OS_Path_validVolume {isAbs : bool, vol} = vol = ""
fun OS_Path_getVolume (path : string) = ""

fun arcs path = #arcs (OS_Path_fromString path)

(* All but the last. *)
fun front xs = List.take (xs, length xs - 1)

fun OS_Path_splitDirFile path =
    let val all = arcs path
        val absolute = OS_Path_isAbsolute path
    in
        if List.null all then {dir = joined (all, absolute), file = ""}
        else {dir = joined (front all, absolute), file = List.last all}
    end

fun OS_Path_joinDirFile {dir, file} =
    let val given = arcs dir
        val all = if List.null given orelse List.last given <> "" then given else front given
        val absolute = OS_Path_isAbsolute dir
    in
        if String.isSubstring "/" file then raise OS.Path.InvalidArc
        else if List.null all andalso not absolute andalso file = "" then ""
        else joined (all ^^ [file], absolute)
    end

fun OS_Path_dir path = #dir (OS_Path_splitDirFile path)
fun OS_Path_file path = #file (OS_Path_splitDirFile path)

fun last_point (file, i) = if i < 0 then ~1 else if String.sub (file, i) = #"." then i else last_point (file, i - 1)

fun OS_Path_splitBaseExt path =
    let val file = OS_Path_file path
        val n = String.size file
        val i = last_point (file, n - 1)
    in
        if i <= 0 orelse i = n - 1 then {base = path, ext = NONE}
        else {base = substring (path, 0, String.size path - (n - i)), ext = SOME (String.extract (file, i + 1, NONE))}
    end

fun OS_Path_joinBaseExt {base, ext} =
    case ext of NONE => base | SOME "" => base | SOME e => base ^ "." ^ e

fun OS_Path_base path = #base (OS_Path_splitBaseExt path)
fun OS_Path_ext path = #ext (OS_Path_splitBaseExt path)

fun OS_Path_mkCanonical path =
    let val absolute = OS_Path_isAbsolute path
        fun clean (nil, kept) = rev kept
          | clean (arc :: rest, kept) =
            if arc = "" orelse arc = "." then clean (rest, kept)
            else if arc = ".." then
                (case kept of
                     last :: before_ => if last = ".." then clean (rest, arc :: kept) else clean (rest, before_)
                   | nil => clean (rest, if absolute then nil else [arc]))
            else clean (rest, arc :: kept)
        val kept = clean (arcs path, nil)
    in if List.null kept andalso not absolute then "." else joined (kept, absolute) end

fun OS_Path_isCanonical path = path = OS_Path_mkCanonical path

fun OS_Path_getParent path =
    let val all = arcs path
        val absolute = OS_Path_isAbsolute path
    in
        if List.null all then (if absolute then "/" else "..")
        else
            let val last = List.last all
            in
                if last = "." orelse last = "" then joined (front all ^^ [".."], absolute)
                else if last = ".." then joined (all ^^ [".."], absolute)
                else if length all = 1 then (if absolute then "/" else ".")
                else joined (front all, absolute)
            end
    end

fun OS_Path_concat (a, b) =
    if OS_Path_isAbsolute b then raise OS.Path.Path
    else
        let val first = arcs a
            val first = if not (List.null first) andalso List.last first = "" then front first else first
        in joined (first ^^ arcs b, OS_Path_isAbsolute a) end

fun OS_Path_mkAbsolute {path, relativeTo} =
    if OS_Path_isAbsolute path then path
    else if not (OS_Path_isAbsolute relativeTo) then raise OS.Path.Path
    else OS_Path_mkCanonical (OS_Path_concat (relativeTo, path))

fun OS_Path_mkRelative {path, relativeTo} =
    if not (OS_Path_isAbsolute relativeTo) then raise OS.Path.Path
    else if not (OS_Path_isAbsolute path) then path
    else
        let fun strip (x :: xs, y :: ys) = if x = y then strip (xs, ys) else (x :: xs, y :: ys)
              | strip (xs, ys) = (xs, ys)
            val (to, base) = strip (arcs (OS_Path_mkCanonical path), arcs (OS_Path_mkCanonical relativeTo))
            val all = List.map (fn _ => "..") base ^^ to
        in if List.null all then "." else joined (all, false) end

fun OS_Path_fromUnixPath (path : string) = path
fun OS_Path_toUnixPath (path : string) = path
