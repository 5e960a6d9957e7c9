// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Tells the bodies of a frame apart by |w|: counts them, gives each taxel to the nearest one, and lists the taxels by
// body. A taxel touches above 5/64 of the largest |w|; touching neighbours along x or y are one blob; blobs with 5/64
// of all |w| are bodies, or the one with most, where none has so much. The one with most comes first, of equal ones
// that whose first taxel comes first. Only the first CONTACTS of them have a region. A frame of one ends when counted.
//
// One memory has a word for each taxel: what sptfra_regions_blobs writes of it, then the number that
// sptfra_regions_bodies gives it, then the region that sptfra_regions_spread finds. From start to counted it is
// 2 * (COLUMNS + 1) * ROWS + WEIGHT_LATENCY + 7 cycles; from counted to parted 4 * max(COLUMNS + 1, 4) * ROWS +
// (COLUMNS + 1) * ROWS + CONTACTS + 6.

`default_nettype none

module sptfra_regions #(
    // Taxels along x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // Most bodies with a region
    parameter CONTACTS = 4,
    // Distances of neighbours in micrometres
    parameter STEP_X = 2000,
    parameter STEP_Y = 2000,
    parameter STEP_DIAGONAL = 2828,
    // Cycles from weight_address to weight
    parameter WEIGHT_LATENCY = 4,
    // From start to counted, and from there to parted, checked in simulation; 0: unchecked
    parameter integer EXPECTED_COUNTED = 0,
    parameter integer EXPECTED_PARTED = 0,
    // Derived
    parameter TAXEL_WIDTH = (COLUMNS * ROWS > 8) ? $clog2(COLUMNS * ROWS) : 3
) (
    input  wire clock,
    input  wire reset,
    // A frame, whose weights are there until it is counted; not before the one before is counted, or parted
    input  wire start,
    input  wire [25:0] largest, // held until then
    output wire [TAXEL_WIDTH-1:0] weight_address,
    input  wire [25:0] weight,
    // What there is, until the next start
    output wire counted,
    output wire [7:0] bodies, // all of them
    output wire [3:0] kept, // those with a region
    output wire [CONTACTS*16-1:0] taxels, // that each of these touches, the first in the lowest bits
    // If kept is above 1: regions, and the taxels sorted by them, a cycle behind their addresses, until the next start
    output wire parted,
    input  wire [TAXEL_WIDTH-1:0] region_address,
    output wire [2:0] region,
    input  wire [TAXEL_WIDTH-1:0] list_address,
    output wire [TAXEL_WIDTH-1:0] list_taxel,
    output wire [CONTACTS*(TAXEL_WIDTH+1)-1:0] sizes
);

    localparam DATA_BITS = 26;
    localparam TAXELS = COLUMNS * ROWS;
    localparam SUM_BITS = DATA_BITS + $clog2(TAXELS);
    localparam COUNT_BITS = $clog2(TAXELS + 1);
    localparam LABEL_WIDTH = (COLUMNS > 4) ? $clog2((COLUMNS + 1) / 2) + 1 : 2;
    localparam RECORD_BITS = SUM_BITS + COUNT_BITS + 2 * LABEL_WIDTH + 2;
    localparam DISTANCE_BITS = $clog2(COLUMNS * STEP_X + ROWS * STEP_DIAGONAL + 1);
    localparam NEAREST_BITS = DISTANCE_BITS + 4;
    localparam [31:0] LAST_TAXEL = TAXELS - 1;
    localparam [31:0] MOST = CONTACTS;

    generate
        // So that regions find room in the words
        if ((STEP_X >= (1 << 21)) || (STEP_Y >= (1 << 21)) || (STEP_DIAGONAL >= (1 << 21))) begin : gen_check_steps
            sptfra_error_steps_must_be_below_2_metres invalid ();
        end
    endgenerate

    // ---- One pass after the other, and the walk over the taxels
    wire begins;
    wire begins_back;
    wire idle;
    wire in_blobs;
    wire in_bodies;
    wire in_there;
    wire in_back;
    wire in_list;
    wire add_up;
    wire several = (kept > 4'd1);
    wire sweeps = in_there || in_back;
    wire walks;
    wire second;
    wire border;
    wire last;
    wire [TAXEL_WIDTH-1:0] taxel;
    wire [LABEL_WIDTH-1:0] fresh;
    wire first_row;
    wire last_row;
    wire before_border;
    wire ends_row;

    assign weight_address = taxel;

    sptfra_regions_passes #(
        .CONTACTS       (CONTACTS),
        .WEIGHT_LATENCY (WEIGHT_LATENCY)
    ) passes (
        .clock       (clock),
        .reset       (reset),
        .start       (start),
        .several     (several),
        .last        (last),
        .begins      (begins),
        .begins_back (begins_back),
        .idle        (idle),
        .blobs       (in_blobs),
        .bodies      (in_bodies),
        .there       (in_there),
        .back        (in_back),
        .list        (in_list),
        .add_up      (add_up),
        .counted     (counted),
        .parted      (parted)
    );

    sptfra_regions_walk #(
        .COLUMNS (COLUMNS),
        .ROWS    (ROWS)
    ) walk (
        .clock         (clock),
        .reset         (reset),
        .start         (begins),
        .back          (begins_back),
        .slow          (sweeps),
        .walks         (walks),
        .second        (second),
        .taxel         (taxel),
        .border        (border),
        .first_row     (first_row),
        .last_row      (last_row),
        .before_border (before_border),
        .ends_row      (ends_row),
        .fresh         (fresh),
        .last          (last)
    );

    // ---- The memory: words come two cycles behind their addresses, and are written in the order of the walk
    wire write;
    wire [RECORD_BITS-1:0] write_data;
    reg [TAXEL_WIDTH-1:0] write_taxel;
    reg write_back;
    wire [TAXEL_WIDTH-1:0] ahead;
    wire [RECORD_BITS-1:0] read_data;
    reg [RECORD_BITS-1:0] word;
    reg [2:1] theres; // taxels of a pass with a step a cycle

    assign region = read_data[2:0];

    always @(posedge clock) begin
        word <= read_data;
        theres <= {theres[1], walks && !border && !sweeps};
        if (write) begin
            write_taxel <= write_back ? write_taxel - 1'b1 : write_taxel + 1'b1;
        end
        if (begins) begin
            write_taxel <= begins_back ? LAST_TAXEL[TAXEL_WIDTH-1:0] : {TAXEL_WIDTH{1'b0}};
            write_back <= begins_back;
        end
        if (reset) begin
            theres <= 2'd0;
        end
    end

    sptfra_ram #(
        .WIDTH         (RECORD_BITS),
        .DEPTH         (1 << TAXEL_WIDTH),
        .ADDRESS_WIDTH (TAXEL_WIDTH)
    ) taxel_words (
        .clock         (clock),
        .write_enable  (write),
        .write_address (write_taxel),
        .write_data    (write_data),
        .read_enable   (1'b1),
        .read_address  (idle ? region_address : (second && sweeps) ? ahead : taxel),
        .read_data     (read_data)
    );

    // ---- Blobs, backwards
    wire [SUM_BITS-1:0] least;
    wire blobs_there;
    wire [RECORD_BITS-1:0] record;

    sptfra_regions_blobs #(
        .COLUMNS        (COLUMNS),
        .DATA_BITS      (DATA_BITS),
        .SUM_BITS       (SUM_BITS),
        .COUNT_BITS     (COUNT_BITS),
        .WEIGHT_LATENCY (WEIGHT_LATENCY)
    ) blobs (
        .clock   (clock),
        .reset   (reset),
        .clear   (start),
        .largest (largest),
        .step    (walks && in_blobs),
        .border  (border),
        .fresh   (fresh),
        .weight  (weight),
        .there   (blobs_there),
        .record  (record),
        .least   (least)
    );

    // ---- Their numbers, the largest of them
    wire numbered;
    wire [3:0] number;
    wire [SUM_BITS-1:0] blob_sum;
    wire blob_begins;
    wire [COUNT_BITS-1:0] blob_taxels;
    wire [3:0] blob_body;
    wire [3:0] found;
    wire [CONTACTS*4-1:0] all_bodies;

    assign bodies = {4'd0, found};
    assign kept = (found > MOST[3:0]) ? MOST[3:0] : found;

    sptfra_regions_bodies #(
        .SUM_BITS    (SUM_BITS),
        .COUNT_BITS  (COUNT_BITS),
        .LABEL_WIDTH (LABEL_WIDTH)
    ) body_numbers (
        .clock    (clock),
        .reset    (reset),
        .clear    (start),
        .least    (least),
        .there    (theres[2] && in_bodies),
        .record   (word),
        .numbered (numbered),
        .number   (number),
        .sum      (blob_sum),
        .begins   (blob_begins),
        .taxels   (blob_taxels),
        .body     (blob_body),
        .bodies   (found)
    );

    sptfra_regions_largest #(
        .CONTACTS   (CONTACTS),
        .SUM_BITS   (SUM_BITS),
        .COUNT_BITS (COUNT_BITS)
    ) largest_blobs (
        .clock      (clock),
        .clear      (start),
        .sum        (blob_sum),
        .begins     (blob_begins),
        .taxels     (blob_taxels),
        .body       (blob_body),
        .all_taxels (taxels),
        .all_bodies (all_bodies)
    );

    // ---- Regions, there and back, and their list
    wire spread_there;
    wire [NEAREST_BITS-1:0] nearest;

    assign write = blobs_there || numbered || spread_there;
    assign write_data = blobs_there ? record :
        {{(RECORD_BITS-NEAREST_BITS){1'b0}}, sweeps ? nearest : {{(NEAREST_BITS-4){1'b0}}, number}};

    sptfra_regions_spread #(
        .CONTACTS      (CONTACTS),
        .TAXELS        (TAXELS),
        .STEP_X        (STEP_X),
        .STEP_Y        (STEP_Y),
        .STEP_DIAGONAL (STEP_DIAGONAL),
        .DISTANCE_BITS (DISTANCE_BITS)
    ) spread (
        .clock         (clock),
        .reset         (reset),
        .all_bodies    (all_bodies),
        .start         (begins),
        .back          (begins_back),
        .numbers       (in_there),
        .walks         (walks && sweeps),
        .second        (second),
        .border        (border),
        .first_row     (first_row),
        .last_row      (last_row),
        .before_border (before_border),
        .ends_row      (ends_row),
        .ahead         (ahead),
        .word          (word[NEAREST_BITS-1:0]),
        .there         (spread_there),
        .nearest       (nearest)
    );

    sptfra_regions_list #(
        .CONTACTS (CONTACTS),
        .TAXELS   (TAXELS)
    ) list (
        .clock        (clock),
        .reset        (reset),
        .clear        (begins && in_there),
        .counts       (spread_there && in_back),
        .counted_body (nearest[2:0]),
        .add_up       (add_up),
        .lists        (theres[2] && in_list),
        .body         (word[2:0]),
        .list_address (list_address),
        .list_taxel   (list_taxel),
        .sizes        (sizes)
    );

`ifdef SIMULATION
    sptfra_check_latency #(
        .CYCLES (EXPECTED_COUNTED)
    ) check_counted (
        .clock (clock),
        .reset (reset),
        .start (start),
        .done  (counted)
    );

    sptfra_check_latency #(
        .CYCLES (EXPECTED_PARTED)
    ) check_parted (
        .clock (clock),
        .reset (reset),
        .start (counted && several),
        .done  (parted)
    );
`else
    wire _unused_check = (EXPECTED_COUNTED != 0) || (EXPECTED_PARTED != 0);
`endif

endmodule

`default_nettype wire
