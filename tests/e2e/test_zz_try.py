import os,pytest
from e2e.test_check_geometry import random_cell, walked, WALKS
pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]
@pytest.mark.parametrize("seed",[200,201,202,203,204,205,206,207])
def test_x(seed,tmp_path):
    b=os.times()
    cell=random_cell(seed,tmp_path); layout,met=walked(cell,tmp_path/"runs")
    e=os.times()
    print("TRY",seed,layout.answer,met,"self %.2f ch %.2f"%(e[0]-b[0]+e[1]-b[1],e[2]-b[2]+e[3]-b[3]),flush=True)
