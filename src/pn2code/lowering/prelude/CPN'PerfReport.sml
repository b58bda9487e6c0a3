fun CPN'PerfReport_selectUntimedStats _ = ()
fun CPN'PerfReport_selectTimedStats _ = ()
