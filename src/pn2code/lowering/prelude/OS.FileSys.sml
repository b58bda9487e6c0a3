fun prim_do_file_change (what : int, name : string) : bool = true
fun prim_do_file_rename (old : string, new : string) : bool = true
fun prim_do_file_is_folder (name : string) : bool = true
fun prim_do_file_size (name : string) : int = 0
fun prim_do_file_may (name : string, modes : int) : bool = true
fun prim_do_file_full_path (name : string) : string = ""
fun prim_do_file_here () : string = ""
fun prim_do_file_names (name : string) : string = ""
fun prim_do_file_problem () : string = ""
fun prim_do_file_problem_name () : OS.syserror = raise Empty
fun prim_do_file_has_failed () : bool = false

fun problem () = raise OS.SysErr (prim_do_file_problem (), SOME (prim_do_file_problem_name ()))

fun checked result = if prim_do_file_has_failed () then problem () else result

fun done true = ()
  | done false = problem ()

fun OS_FileSys_getDir () = prim_do_file_here ()
fun OS_FileSys_mkDir name = done (prim_do_file_change (0, name))
fun OS_FileSys_rmDir name = done (prim_do_file_change (1, name))
fun OS_FileSys_remove name = done (prim_do_file_change (2, name))
fun OS_FileSys_chDir name = done (prim_do_file_change (3, name))
fun OS_FileSys_rename {old, new} = done (prim_do_file_rename (old, new))

fun OS_FileSys_isDir name = let val found = prim_do_file_is_folder name in checked found end
fun OS_FileSys_fileSize name = let val size = prim_do_file_size name in checked size end
fun OS_FileSys_fullPath name = let val path = prim_do_file_full_path name in checked path end
fun OS_FileSys_isLink name = OS_FileSys_fullPath name = ""

fun OS_FileSys_realPath name =
    let val path = OS_FileSys_fullPath name
    in
        if OS.Path.isAbsolute name then path
        else OS.Path.mkRelative {path = path, relativeTo = prim_do_file_here ()}
    end

fun mode OS.FileSys.A_READ = 1
  | mode OS.FileSys.A_WRITE = 2
  | mode OS.FileSys.A_EXEC = 4

fun sum (nil, total) = total
  | sum (m :: rest, total) = sum (rest, if List.exists (fn x => x = m) rest then total else total + mode m)

fun OS_FileSys_access (name, modes) = prim_do_file_may (name, sum (modes, 0))

(* A folder that is read is its names, how many have been read, and whether it is closed. *)
fun OS_FileSys_openDir name =
    let val names = prim_do_file_names name
    in checked (String.tokens (fn c => c = #"/") names, ref 0, ref false) end

fun OS_FileSys_readDir (names : string list, at, closed) =
    if !closed then raise OS.SysErr ("the folder is closed", NONE)
    else if !at >= length names then NONE
    else (at := !at + 1; SOME (List.nth (names, !at - 1)))

fun OS_FileSys_rewindDir (_ : string list, at, _ : bool ref) = at := 0
fun OS_FileSys_closeDir (_ : string list, _ : int ref, closed) = closed := true
